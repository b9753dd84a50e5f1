// SPDX-License-Identifier: Apache-2.0
//
// What goes wrong with sensors, cables, disks and operators, on convexcutd live as users run it.
// Does not prove anything about real sensors, adapters and network cards; a host clock that is set
// and a CAN bus that goes off are in tests/vm.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <sys/resource.h>

#include <gmock/gmock.h>

#include "drivers/velodyne/wire_layout.hpp"
#include "drivers/wire.hpp"
#include "tests/daemon/live/live_fault.hpp"
#include "tests/support/network_namespace.hpp"

namespace convexcut::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

class PacketLoss : public LiveFault, public ::testing::WithParamInterface<const char*> {};

TEST_P(PacketLoss, IsCountedToThePacketAndScansGoOn) {
  make_room({"--seconds", "3", "--empty"});
  play({"--loss", GetParam()});
  const long arrived = ended_with("packets");
  EXPECT_GT(counted(sent_.out, "data_packets"), arrived);
  EXPECT_EQ(ended_with("lost_packets"), counted(sent_.out, "data_packets") - arrived);
  EXPECT_EQ(arrived + ended_with("position_packets"), counted(sent_.out, "datagrams_sent"));
  EXPECT_EQ(ended_with("late_packets"), 0);
  EXPECT_GE(scans(), 28);
  expect_results_all_the_time();
  expect_nothing_dropped_here();
  // One percent is where the state begins to say so.
  if (std::string(GetParam()) == "0.1") {
    EXPECT_THAT(run_.err, HasSubstr("lidar losing input"));
  }
}

INSTANTIATE_TEST_SUITE_P(Share, PacketLoss, ::testing::Values("0.01", "0.1"),
                         [](const auto& test) { return "Of" + std::string(test.param).substr(2); });

TEST_F(LiveFault, PacketsTwiceAndOutOfOrderAreCountedAndNothingIsLost) {
  make_room({"--seconds", "2", "--empty"});
  play({"--duplicate", "0.05", "--reorder", "0.05"});
  EXPECT_EQ(ended_with("lost_packets"), 0) << run_.err;
  EXPECT_EQ(ended_with("late_packets"), 0);
  EXPECT_GT(ended_with("duplicate_packets"), 100);
  EXPECT_EQ(ended_with("duplicate_packets"),
            ended_with("packets") - counted(sent_.out, "data_packets"));
  EXPECT_GT(ended_with("reordered_packets"), 100);
  EXPECT_LE(ended_with("reordered_packets"), counted(sent_.out, "datagrams_reordered"));
  EXPECT_GE(scans(), 18);
  expect_results_all_the_time();
}

TEST_F(LiveFault, PacketsThatAreHeldUpOnTheWayAreAllUsed) {
  make_room({"--seconds", "2", "--empty"});
  play({"--delay", "20"});
  EXPECT_EQ(ended_with("packets"), counted(sent_.out, "data_packets"));
  EXPECT_EQ(ended_with("lost_packets"), 0) << run_.err;
  EXPECT_EQ(ended_with("late_packets"), 0);
  EXPECT_GE(scans(), 18);
  expect_results_all_the_time();
  expect_nothing_dropped_here();
}

TEST_F(LiveFault, GarbageDatagramsAreCountedAndNothingIsLost) {
  make_room({"--seconds", "2", "--empty"});
  play({"--garbage", "0.05"});
  EXPECT_GT(ended_with("rejected_packets"), 100);
  EXPECT_EQ(ended_with("rejected_packets"), counted(sent_.out, "datagrams_garbage"));
  EXPECT_EQ(ended_with("packets"), counted(sent_.out, "data_packets"));
  EXPECT_EQ(ended_with("lost_packets"), 0);
  EXPECT_GE(scans(), 18);
}

TEST_F(LiveFault, LidarThatIsSwitchedOffAndOnIsStaleThenStreamsAgain) {
  make_room({"--seconds", "3", "--empty"});
  start_daemon({"mount.orientation=fixed"});
  {
    BackgroundProgram first("convexcut", with(replay_of_lidar(), {"--loop"}));
    becomes("lidar", "streaming", kRecovery);
    std::this_thread::sleep_for(seconds{1});
    EXPECT_EQ(first.stop().status, 0);
  }
  becomes("lidar", "stale", 1.0);
  std::this_thread::sleep_for(seconds{1});
  const long empty_before = logged(dump(), "info health_totals", "empty_results");
  BackgroundProgram second("convexcut", with(replay_of_lidar(), {"--loop"}));
  becomes("lidar", "streaming", kRecovery);
  const long empty_after = logged(dump(), "info health_totals", "empty_results");
  std::this_thread::sleep_for(seconds{1});
  const long empty_later = logged(dump(), "info health_totals", "empty_results");
  EXPECT_EQ(second.stop().status, 0);
  stop();
  EXPECT_GT(empty_before, 5);
  EXPECT_LE(empty_after - empty_before, 5) << "scans come at once";
  EXPECT_EQ(empty_later, empty_after);
  EXPECT_THAT(run_.err, HasSubstr("source name=lidar state=stale was=streaming"));
  EXPECT_THAT(run_.err, HasSubstr("reasons=\"lidar stale"));
  expect_results_all_the_time();
  expect_nothing_dropped_here();
}

TEST_F(LiveFault, StallOfASensorWhoseClockGoesOnIsFollowedByScans) {
  make_room({"--seconds", "3.4", "--empty"});
  play({"--stall", "0.5", "--stall-every", "1.5"});
  const ProgramResult info = run_program("convexcut", {"info", "--json", "--lidar", lidar()});
  EXPECT_GT(ended_with("lost_packets"), 1000);
  EXPECT_EQ(ended_with("packets") + ended_with("lost_packets"), counted(info.out, "data_packets"))
      << sent_.out << run_.err;
  EXPECT_THAT(run_.err, HasSubstr("source name=lidar state=stale was=streaming"));
  EXPECT_GE(scans(), 20);
  expect_results_all_the_time();
  expect_nothing_dropped_here();
}

TEST_F(LiveFault, DaemonThatIsThereFirstTakesSensorsThatComeLater) {
  make_room({"--seconds", "3", "--empty"});
  const std::string link = path("imu").string();
  start_daemon({"imu.device=" + link});
  std::this_thread::sleep_for(seconds{3});
  const std::string before = dump();
  EXPECT_THAT(before, HasSubstr("health_source name=lidar state=waiting"));
  EXPECT_THAT(before, HasSubstr("health_source name=imu state=absent"));
  EXPECT_THAT(before, HasSubstr("info health state=starting"));
  BackgroundProgram replay("convexcut",
                           with(replay_of_lidar(), {"--imu", imu(), "--imu-link", link, "--loop"}));
  becomes("lidar", "streaming", kRecovery);
  becomes("imu", "streaming", kRecovery);
  std::this_thread::sleep_for(seconds{1});
  EXPECT_EQ(replay.stop().status, 0);
  stop();
  EXPECT_GT(scans(), 8);
  expect_results_all_the_time();
  expect_nothing_dropped_here();
}

class Rotor : public LiveFault, public ::testing::WithParamInterface<int> {};

// Results come ten times a second: of a faster rotor's scans the newest.
TEST_P(Rotor, GivesAResultForEachRevolutionUpToOneForEachPeriod) {
  make_room({"--seconds", "2", "--empty", "--rate-hz", std::to_string(GetParam())});
  play({});
  const long superseded = std::max(0L, logged(run_.err, "losses", "superseded_scans"));
  EXPECT_NEAR(static_cast<double>(scans() + superseded), 2.0 * GetParam(), 2.0) << run_.err;
  if (GetParam() <= 11) {
    EXPECT_LE(superseded, 1) << run_.err;
  }
  EXPECT_EQ(ended_with("lost_packets"), 0);
  expect_nothing_dropped_here();
}

INSTANTIATE_TEST_SUITE_P(Hz, Rotor, ::testing::Values(9, 11, 20),
                         [](const auto& test) { return std::to_string(test.param); });

// The lidar's recording with every datagram changed in place. Demo rooms are little-endian pcap
// files of Ethernet frames with IPv4 without options.
class ChangedRecording : public LiveFault {
 protected:
  static constexpr std::size_t kFileHeader = 24;
  static constexpr std::size_t kRecordHeader = 16;
  static constexpr std::size_t kCapturedLength = 8;
  static constexpr std::size_t kFrameHeaders = 14 + 20 + 8;

  template <typename Change>
  void change_packets(Change change) const {
    std::string file = text(lidar());
    for (std::size_t at = kFileHeader; at < file.size();) {
      const std::span<std::byte> all = std::as_writable_bytes(std::span(file));
      const auto length = wire::load_le<std::uint32_t>(all, at + kCapturedLength);
      at += kRecordHeader;
      change(all.subspan(at + kFrameHeaders, length - kFrameHeaders));
      at += length;
    }
    write(lidar(), file);
  }
};

TEST_F(ChangedRecording, TopOfTheHourIsNothingSpecial) {
  namespace layout = velodyne::wire_layout;
  make_room({"--seconds", "2", "--empty", "--no-pps"});
  std::uint32_t first = 0;
  bool wrapped = false;
  change_packets([&](std::span<std::byte> payload) {
    const bool data = payload.size() == layout::kDataPacketSize;
    const std::size_t at = data ? layout::kDataTimestamp : layout::kPositionTimestamp;
    const auto time = wire::load_le<std::uint32_t>(payload, at);
    if (first == 0) first = time;
    const auto moved = static_cast<std::uint32_t>(
        (std::int64_t{time} - first + layout::kMicrosPerHour - 1'000'000 + layout::kMicrosPerHour) %
        layout::kMicrosPerHour);
    wrapped = wrapped || moved < 900'000;
    wire::store_le<std::uint32_t>(payload, at, moved);
  });
  ASSERT_TRUE(wrapped);
  play({});
  EXPECT_EQ(ended_with("packets"), counted(sent_.out, "data_packets"));
  EXPECT_EQ(ended_with("lost_packets"), 0);
  EXPECT_EQ(ended_with("rejected_packets"), 0);
  EXPECT_GE(scans(), 18);
  expect_results_all_the_time();
  EXPECT_LE(logged(run_.err, "losses", "clock_steps"), 0) << run_.err;
}

TEST_F(ChangedRecording, RotorThatStandsGivesResultsAllTheTime) {
  namespace layout = velodyne::wire_layout;
  make_room({"--seconds", "2.4", "--empty"});
  change_packets([&](std::span<std::byte> payload) {
    if (payload.size() != layout::kDataPacketSize) return;
    for (std::size_t block = 0; block < layout::kBlocks; ++block) {
      wire::store_le<std::uint16_t>(payload, block * layout::kBlockSize + layout::kBlockAzimuth,
                                    9000);
    }
  });
  play({});
  EXPECT_EQ(ended_with("packets"), counted(sent_.out, "data_packets"));
  // A revolution that does not end is given out after 300 ms.
  EXPECT_NEAR(static_cast<double>(scans()), 2400.0 / 300.0, 2.0);
  EXPECT_THAT(run_.err, HasSubstr("lidar not turning"));
  expect_results_all_the_time();
  expect_nothing_dropped_here();
}

TEST_F(LiveFault, FullDiskStopsTheRecordingAloneAndSpaceStartsItAgain) {
  make_room({"--seconds", "4", "--empty"});
  ProgramLimits disk;
  disk.file_size_bytes = 1'000'000;
  start_listening_daemon({"record.directory=" + path("rec").string()}, disk);
  BackgroundProgram replay("convexcut", with(replay_of_lidar(), {"--loop"}));
  ASSERT_TRUE(daemon_->wait_for("recording is stopped"));
  std::this_thread::sleep_for(seconds{2});
  EXPECT_GT(logged(dump(), "info health_totals", "unrecorded_records"), 1000);
  EXPECT_THAT(dump(), HasSubstr("recording incomplete"));
  rlimit limit{};
  ASSERT_EQ(::prlimit(daemon_->pid(), RLIMIT_FSIZE, nullptr, &limit), 0);
  limit.rlim_cur = limit.rlim_max;
  ASSERT_EQ(::prlimit(daemon_->pid(), RLIMIT_FSIZE, &limit, nullptr), 0);
  ASSERT_TRUE(daemon_->wait_for("info recording note"));  // the next try, at most 10 s later
  std::this_thread::sleep_for(seconds{1});
  const ProgramResult sent = replay.stop();
  stop();
  const std::size_t said = run_.err.find("recording is stopped");
  EXPECT_EQ(run_.err.find("recording is stopped", said + 1), std::string::npos) << run_.err;
  EXPECT_EQ(ended_with("packets"), counted(sent.out, "data_packets"));
  EXPECT_EQ(ended_with("lost_packets"), 0);
  expect_results_all_the_time();
  for (const char* file : {"rec/lidar_000.pcap", "rec/lidar_001.pcap"}) {
    EXPECT_GT(packets_recorded_in(file), 500);
  }
}

TEST_F(LiveFault, SigtermUnderLoadEndsAtOnceAndLeavesAReadableRecording) {
  make_room({"--seconds", "3", "--empty"});
  start_listening_daemon({"record.directory=" + path("rec").string()});
  BackgroundProgram replay("convexcut", with(replay_of_lidar(), {"--rate", "20", "--loop"}));
  std::this_thread::sleep_for(seconds{3});
  const auto before = std::chrono::steady_clock::now();
  stop();
  EXPECT_LT(std::chrono::steady_clock::now() - before, milliseconds{1000});
  EXPECT_EQ(replay.stop().status, 0);
  EXPECT_GT(ended_with("packets"), 1000);
  EXPECT_GT(packets_recorded_in("rec/lidar_000.pcap"), 10'000);
}

TEST_F(LiveFault, CableThatIsPulledAndPutBackIsToldAndNeedsNoRestart) {
  make_room({"--seconds", "3", "--empty"});
  in_network_namespace([this] {
    ip("link set lo up");
    ip("link add sensor type veth peer name host");
    ip("address add 192.168.1.201/24 dev sensor");
    ip("link set sensor up");
    set_ipv4("all", "rp_filter", 0);
    // The sensor's packets come from an address that is also this host's own.
    set_ipv4("host", "accept_local", 1);
    set_ipv4("host", "rp_filter", 0);
    start_daemon({"mount.orientation=fixed", "lidar.interface=host"});
    becomes("lidar", "absent", 1.0);
    ip("link set host up");
    becomes("lidar", "waiting", 2.0);
    BackgroundProgram replay("convexcut",
                             with(replay_of_lidar(), {"--to-address", "192.168.1.255", "--loop"}));
    becomes("lidar", "streaming", kRecovery);
    ip("link set sensor down");
    becomes("lidar", "absent", 2.0);
    const std::string cut = dump();
    const long scans_before = logged(cut, "info health_totals", "results") -
                              logged(cut, "info health_totals", "empty_results");
    ip("link set sensor up");
    becomes("lidar", "streaming", kRecovery);
    std::this_thread::sleep_for(seconds{1});
    const ProgramResult sent = replay.stop();
    EXPECT_EQ(sent.status, 0) << sent.err;
    stop();
    // Of a pause of less than a second the sensor's clock tells how many are missing.
    EXPECT_EQ(ended_with("packets") + ended_with("lost_packets"),
              counted(sent.out, "data_packets"));
    EXPECT_GT(scans(), scans_before + 8) << "scans go on after the cable is back";
    expect_results_all_the_time();
  });
}

}  // namespace
}  // namespace convexcut::test
