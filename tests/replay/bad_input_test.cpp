// SPDX-License-Identifier: Apache-2.0
//
// What the programs say and leave behind when the input is bad: one clear line, the right exit
// status, nothing half-written under a final name. Does not prove that every such line is
// understood.
#include <algorithm>
#include <cstring>

#include <sys/mount.h>

#include <gmock/gmock.h>

#include "tests/support/room.hpp"

namespace convexcut::test {
namespace {

using ::testing::HasSubstr;

constexpr int kFailed = 1;
constexpr int kUsage = 2;

class BadInput : public RoomTest {
 protected:
  // Fails with one line that names `what`, and leaves no file under a final name.
  void expect_failure(const ProgramResult& run, int status, const std::vector<std::string>& what) {
    EXPECT_EQ(run.status, status) << run.err;
    EXPECT_EQ(run.error_lines(), 1U) << run.err;
    for (const std::string& part : what) EXPECT_THAT(run.err, HasSubstr(part));
    EXPECT_EQ(names(out()), std::vector<std::string>{}) << run.err;
  }
  [[nodiscard]] ProgramResult process_fixed(const std::string& file) const {
    return process({"--lidar", file, "--set", "mount.orientation=fixed"});
  }
  // The packets of a pcap file, each with its record header, behind the file header.
  static constexpr std::size_t kFileHeader = 24;
};

TEST_F(BadInput, MissingFile) {
  const std::string file = path("none.pcap").string();
  expect_failure(process_fixed(file), kFailed, {file, "No such file"});
}

TEST_F(BadInput, AnOptionWithAnEmptyValue) {
  make_room({"--seconds", "0.1"});
  expect_failure(process_fixed(""), kUsage, {"--lidar is empty", "expected FILE"});
  expect_failure(process({"--lidar", lidar(), "--imu", ""}), kUsage, {"--imu is empty"});
}

TEST_F(BadInput, EmptyFile) {
  write(path("empty.pcap"), "");
  expect_failure(process_fixed(path("empty.pcap").string()), kFailed, {"empty.pcap", "empty"});
}

TEST_F(BadInput, ADirectoryInPlaceOfAFile) {
  expect_failure(process_fixed(path(".").string()), kFailed, {"directory"});
}

TEST_F(BadInput, NotACapture) {
  write(path("text.pcap"), std::string(5000, 'x'));
  expect_failure(process_fixed(path("text.pcap").string()), kFailed, {"text.pcap", "capture"});
}

TEST_F(BadInput, ACaptureCutMidRecordGivesWhatIsWholeAndAWarning) {
  make_room({"--seconds", "0.3"});
  std::string bytes = text(lidar());
  bytes.resize(bytes.size() - 700);
  write(path("cut.pcap"), bytes);
  const ProgramResult run = process_fixed(path("cut.pcap").string());
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.error_lines(), 1U) << run.err;
  EXPECT_THAT(run.err, HasSubstr("warning: "));
  EXPECT_THAT(run.err, HasSubstr("cut.pcap"));
  EXPECT_EQ(names(out()).back(), "scans.csv");
}

TEST_F(BadInput, ACaptureWithoutLidarPackets) {
  make_room({"--seconds", "0.1"});
  const ProgramResult run =
      process({"--lidar", lidar(), "--set", "mount.orientation=fixed", "--set",
               "lidar.data_port=2369", "--set", "lidar.position_port=8309"});
  expect_failure(run, kFailed, {"lidar.pcap", "no lidar packets", "1206", "other ports"});
}

TEST_F(BadInput, ASerialRecordingGivenAsLidar) {
  make_room({"--seconds", "0.1"});
  expect_failure(process_fixed(imu()), kFailed, {"imu.pcap", "--imu"});
}

TEST_F(BadInput, AWrongLinkType) {
  make_room({"--seconds", "0.1"});
  std::string bytes = text(lidar());
  bytes[20] = 105;  // LINKTYPE_IEEE802_11
  write(path("wifi.pcap"), bytes);
  expect_failure(process_fixed(path("wifi.pcap").string()), kFailed, {"wifi.pcap", "link type"});
}

TEST_F(BadInput, ALidarCaptureGivenAsImu) {
  make_room({"--seconds", "0.1"});
  expect_failure(process({"--lidar", lidar(), "--imu", lidar()}), kFailed,
                 {"lidar.pcap", "serial"});
}

TEST_F(BadInput, AnImuLogWithoutFrames) {
  make_room({"--seconds", "0.1"});
  write(path("noise.bin"), std::string(10'000, 'n'));
  expect_failure(process({"--lidar", lidar(), "--imu", path("noise.bin").string()}), kFailed,
                 {"noise.bin", "no orientation", "0 Xbus frames"});
}

TEST_F(BadInput, ACanLogWithoutFrames) {
  make_room({"--seconds", "0.1"});
  write(path("noise.log"), "not a log\nat all\n");
  expect_failure(process({"--lidar", lidar(), "--can", path("noise.log").string()}), kFailed,
                 {"noise.log", "no orientation"});
}

// The bytes of all reads of a serial capture, one after the other.
std::string serial_bytes(const std::string& capture) {
  std::string bytes;
  for (std::size_t at = 24; at + 16 <= capture.size();) {
    std::uint32_t length = 0;
    std::memcpy(&length, capture.data() + at + 8, sizeof length);
    bytes += capture.substr(at + 16, length);
    at += 16 + length;
  }
  return bytes;
}

TEST_F(BadInput, GarbageBetweenImuFramesIsSkippedAndCounted) {
  make_room({"--seconds", "0.5"});
  const std::string clean = serial_bytes(text(imu()));
  // Garbage that looks like the start of frames, before, between and after.
  const std::string garbage("\xFA\xFF\x36\xFF\x08\x01 noise \xFA\xFF", 15);
  std::string dirty = garbage;
  std::size_t frames = 0;
  for (std::size_t at = 0; at + 5 <= clean.size(); ++frames) {
    const std::size_t size = static_cast<unsigned char>(clean[at + 3]) + 5U;
    dirty += clean.substr(at, size);
    if (frames % 5 == 0) dirty += garbage;
    at += size;
  }
  dirty += garbage;
  write(path("dirty.bin"), dirty);
  const ProgramResult info =
      run_program("convexcut", {"info", "--imu", path("dirty.bin").string(), "--json"});
  ASSERT_EQ(info.status, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("\"frames\": " + std::to_string(frames)));
  const ProgramResult run = process({"--lidar", lidar(), "--imu", path("dirty.bin").string()});
  EXPECT_EQ(run.status, 0) << run.err;
}

TEST_F(BadInput, ImuAndLidarThatDoNotOverlapInTime) {
  make_room({"--seconds", "0.5"});
  write(path("imu.bin"), serial_bytes(text(imu())));
  for (const std::string start : {"-100", "100"}) {
    const ProgramResult run =
        process({"--lidar", lidar(), "--imu", path("imu.bin").string(), "--imu-start", start});
    expect_failure(run, kFailed, {"do not overlap in time", "--imu-start"});
  }
}

TEST_F(BadInput, OrientationMissingForPartOfAScanIsCountedAndSaid) {
  make_room({"--seconds", "0.6"});
  write(path("imu.bin"), serial_bytes(text(imu())));
  const ProgramResult run =
      process({"--lidar", lidar(), "--imu", path("imu.bin").string(), "--imu-start", "0.25"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("dropped for want of an orientation"));
  std::size_t partial = 0;
  for (const std::string& name : names(out())) {
    const std::string file = text(path("scans") / name);
    if (name == "scans.csv") continue;
    const std::size_t at = file.find("dropped_no_orientation ");
    ASSERT_NE(at, std::string::npos);
    const auto dropped = std::stoul(file.substr(at + 23));
    const auto points = std::stoul(file.substr(file.find("POINTS ") + 7));
    partial += dropped > 0 && points > 0 ? 1 : 0;
  }
  EXPECT_EQ(partial, 1U);  // the one in which the IMU starts
}

TEST_F(BadInput, NoOrientationSourceAtAll) {
  make_room({"--seconds", "0.1"});
  expect_failure(process({"--lidar", lidar()}), kUsage, {"mount.orientation", "--imu"});
}

TEST_F(BadInput, EveryErrorOfAConfigurationIsListedAtOnceWithItsLine) {
  make_room({"--seconds", "0.1"});
  write(path("bad.toml"),
        "[lidar]\n"
        "min_range_m = \"near\"\n"
        "modle = \"auto\"\n"
        "[convex_cut]\n"
        "planes = 0\n");
  const ProgramResult run = process({"--lidar", lidar(), "--config", path("bad.toml").string()});
  EXPECT_EQ(run.status, kUsage);
  EXPECT_EQ(run.error_lines(), 3U) << run.err;
  EXPECT_THAT(run.err, HasSubstr("bad.toml:2"));
  EXPECT_THAT(run.err, HasSubstr("bad.toml:3"));
  EXPECT_THAT(run.err, HasSubstr("lidar.model"));  // what was probably meant
  EXPECT_THAT(run.err, HasSubstr("bad.toml:5"));
  EXPECT_EQ(names(out()), std::vector<std::string>{});
}

TEST_F(BadInput, AWrongOverride) {
  make_room({"--seconds", "0.1"});
  expect_failure(process({"--lidar", lidar(), "--set", "convex_cut.planes=none"}), kUsage,
                 {"--set", "convex_cut.planes", "none"});
}

TEST_F(BadInput, WrongUsageIsOneLine) {
  expect_failure(run_program("convexcut", {"process", "--nonsense"}), kUsage, {"--help"});
  expect_failure(run_program("convexcut", {}), kUsage, {"--help"});
  expect_failure(run_program("convexcut", {"info"}), kUsage, {"--lidar"});
  expect_failure(run_program("convexcutd", {"--lidar", "x", "--rate", "0"}), kUsage,
                 {"--rate", "max"});
}

TEST_F(BadInput, AnOutputDirectoryThatCannotBeMade) {
  make_room({"--seconds", "0.1"});
  write(path("scans"), "a file where the directory should be");
  const ProgramResult run = process({"--lidar", lidar(), "--set", "mount.orientation=fixed"});
  EXPECT_EQ(run.status, kFailed);
  EXPECT_EQ(run.error_lines(), 1U) << run.err;
  EXPECT_THAT(run.err, HasSubstr(out()));
}

TEST_F(BadInput, AFileThatMayGrowNoFurtherLeavesNothingHalfWritten) {
  make_room({"--seconds", "0.3"});
  ProgramLimits limits;
  limits.file_size_bytes = 1'000'000;  // a partial revolution fits, a whole one (1.35 MB) does not
  const ProgramResult run =
      process({"--lidar", lidar(), "--set", "mount.orientation=fixed"}, limits);
  EXPECT_EQ(run.status, kFailed);
  EXPECT_EQ(run.error_lines(), 1U) << run.err;
  EXPECT_THAT(run.err, HasSubstr("scan_000001.pcd: File too large"));
  EXPECT_EQ(names(out()), std::vector<std::string>{"scan_000000.pcd"});
}

TEST_F(BadInput, AFullDiskLeavesNothingHalfWritten) {
  make_room({"--seconds", "0.3"});
  std::filesystem::create_directories(out());
  if (::mount("tmpfs", out().c_str(), "tmpfs", 0, "size=1m") != 0) {
    GTEST_SKIP() << "needs the right to mount a small tmpfs";
  }
  const ProgramResult run = process({"--lidar", lidar(), "--set", "mount.orientation=fixed"});
  const auto left = names(out());
  EXPECT_EQ(::umount(out().c_str()), 0);
  EXPECT_EQ(run.status, kFailed);
  EXPECT_EQ(run.error_lines(), 1U) << run.err;
  EXPECT_THAT(run.err, HasSubstr("No space left on device"));
  EXPECT_EQ(left, std::vector<std::string>{"scan_000000.pcd"});
}

}  // namespace
}  // namespace convexcut::test
