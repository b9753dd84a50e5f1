// SPDX-License-Identifier: Apache-2.0
//
// `convexcut record` as users run it, fed by `convexcut replay` over loopback and a pseudo
// terminal. Does not prove that it keeps up with a sensor on a busy machine.
#include <string>
#include <thread>

#include <unistd.h>

#include <gmock/gmock.h>

#include "drivers/capture/capture_reader.hpp"
#include "tests/support/room.hpp"

namespace convexcut::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class RecordProgram : public RoomTest {
 protected:
  // Settings of a rig of this test's own: ports that no other test uses, a terminal as the IMU.
  [[nodiscard]] std::vector<std::string> rig() const {
    const int port = 20'000 + ::getpid() % 10'000 * 2;
    return {"--set", "lidar.data_port=" + std::to_string(port),
            "--set", "lidar.position_port=" + std::to_string(port + 1),
            "--set", "imu.device=" + path("imu").string(),
            "--set", "imu.baud=0"};
  }
  [[nodiscard]] std::vector<std::string> with_rig(std::vector<std::string> arguments) const {
    const std::vector<std::string> more = rig();
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  // Records until the sensors, which play the room once, are gone: the IMU's terminal with them.
  [[nodiscard]] ProgramResult record_the_room(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments =
        with_rig({"record", "--out", path("rec").string(), "--seconds", "60"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    ProgramLimits limits = limits_;
    limits.terminate_at = "is absent";
    std::thread sensors([this] {
      played_ = run_program("convexcut",
                            with_rig({"replay", "--lidar", lidar(), "--imu", imu(), "--imu-link",
                                      path("imu").string(), "--wait", "20", "--json"}));
    });
    ProgramResult recorded = run_program("convexcut", arguments, limits);
    sensors.join();
    return recorded;
  }
  [[nodiscard]] std::uint64_t records_in(const std::string& name) const {
    capture::CaptureReader reader(path("rec") / name);
    capture::Record record;
    std::uint64_t count = 0;
    while (reader.next(record) == capture::ReadStatus::record) ++count;
    return count;
  }

  ProgramLimits limits_;
  ProgramResult played_;
};

// The number behind "key": in a line of JSON.
std::uint64_t figure(const std::string& json, const std::string& key) {
  const std::size_t at = json.find("\"" + key + "\": ");
  return at == std::string::npos ? 0 : std::stoull(json.substr(at + key.size() + 4));
}

TEST_F(RecordProgram, RecordsEveryPacketAndReadThatTheSensorsSend) {
  make_room({"--seconds", "2"});
  const ProgramResult recorded = record_the_room({"--json"});
  EXPECT_EQ(recorded.status, 0) << recorded.err << recorded.out;
  EXPECT_THAT(names(path("rec")), ElementsAre("imu_000.pcap", "lidar_000.pcap"));
  EXPECT_EQ(records_in("lidar_000.pcap"), figure(played_.out, "datagrams_sent")) << played_.err;
  EXPECT_GT(records_in("imu_000.pcap"), 0U);
  EXPECT_EQ(figure(recorded.out, "missing"), 0U);
  EXPECT_EQ(figure(recorded.out, "records"),
            records_in("lidar_000.pcap") + records_in("imu_000.pcap"));
  EXPECT_THAT(recorded.err, HasSubstr("lidar (UDP ports "));
  EXPECT_THAT(recorded.err, HasSubstr("is streaming"));
}

TEST_F(RecordProgram, TheRecordingIsProcessedLikeAnyOther) {
  make_room({"--seconds", "1"});
  ASSERT_EQ(record_the_room().status, 0);
  const ProgramResult processed = process(with_rig({"--lidar", path("rec/lidar_000.pcap").string(),
                                                    "--imu", path("rec/imu_000.pcap").string()}));
  EXPECT_EQ(processed.status, 0) << processed.err;
  EXPECT_THAT(names(out()), ::testing::Contains("scan_000003.pcd"));
}

TEST_F(RecordProgram, AFullDiskIsOneLineAndTheSensorsAreHeardOn) {
  make_room({"--seconds", "2"});
  limits_.file_size_bytes = 300'000;
  const ProgramResult recorded = record_the_room();
  EXPECT_EQ(recorded.status, 1);
  const std::size_t said = recorded.err.find("recording is stopped");
  EXPECT_NE(said, std::string::npos) << recorded.err;
  EXPECT_EQ(recorded.err.find("recording is stopped", said + 1), std::string::npos);
  EXPECT_THAT(recorded.out, HasSubstr("missing "));
  EXPECT_GT(records_in("lidar_000.pcap"), 200U);
}

TEST_F(RecordProgram, SilentSensorsAreStatusOneAndALine) {
  const ProgramResult recorded = run_program(
      "convexcut", with_rig({"record", "--out", path("rec").string(), "--seconds", "0.3"}));
  EXPECT_EQ(recorded.status, 1);
  EXPECT_THAT(recorded.err, HasSubstr("convexcut record: nothing was recorded; imu: "));
  EXPECT_THAT(recorded.err, HasSubstr("No such file or directory"));
}

TEST_F(RecordProgram, WithoutADirectoryItIsWrongUsage) {
  const ProgramResult recorded = run_program("convexcut", with_rig({"record"}));
  EXPECT_EQ(recorded.status, 2);
  EXPECT_EQ(recorded.error_lines(), 1U) << recorded.err;
  EXPECT_THAT(recorded.err, HasSubstr("--out DIR"));
}

TEST_F(RecordProgram, ADirectoryThatCannotBeMadeIsOneLine) {
  const ProgramResult recorded =
      run_program("convexcut", with_rig({"record", "--out", "/proc/self/status/rec"}));
  EXPECT_EQ(recorded.status, 1);
  EXPECT_EQ(recorded.error_lines(), 1U) << recorded.err;
  EXPECT_THAT(recorded.err, HasSubstr("/proc/self/status/rec: cannot make this directory"));
}

}  // namespace
}  // namespace convexcut::test
