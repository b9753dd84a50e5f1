// SPDX-License-Identifier: Apache-2.0
//
// convexcutd on recordings, over real DDS between processes. Does not prove anything about latency
// on a loaded machine, nor about live input.
#include <algorithm>
#include <string>
#include <thread>

#include <unistd.h>

#include <gmock/gmock.h>

#include "tests/support/room.hpp"

namespace convexcut::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class DaemonProgram : public RoomTest {
 protected:
  // A DDS domain of this test's own.
  static std::string domain() { return std::to_string(1 + ::getpid() % 99); }

  [[nodiscard]] static ProgramResult run_daemon(const std::vector<std::string>& arguments,
                                                const ProgramLimits& limits = {}) {
    std::vector<std::string> all{"--set", "dds.domain=" + domain()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run_program("convexcutd", all, limits);
  }
  // The number behind `key=` in the line of the log that starts with `event`.
  [[nodiscard]] static long figure(const std::string& log, const std::string& event,
                                   const std::string& key) {
    const std::size_t line = log.rfind(event);
    const std::size_t at = log.find(key + "=", line == std::string::npos ? log.size() : line);
    return at == std::string::npos ? -1 : std::stol(log.substr(at + key.size() + 1));
  }
  [[nodiscard]] static long lines(const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
  }
};

TEST_F(DaemonProgram, PublishesEveryScanOfARecordingThatProcessWrites) {
  make_room({"--seconds", "2"});
  ASSERT_EQ(process({"--lidar", lidar(), "--imu", imu()}).status, 0);
  const long scans = lines(text(path("scans") / "scans.csv")) - 1;
  const ProgramResult run = run_daemon({"--lidar", lidar(), "--imu", imu(), "--rate", "max"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(figure(run.err, "info end", "scans"), scans) << run.err;
  EXPECT_EQ(figure(run.err, "info end", "late"), 0);
  EXPECT_THAT(run.err, Not(HasSubstr("dropped_scans=1")));
}

TEST_F(DaemonProgram, WatchSeesTheTopicsOfAnotherProcess) {
  make_room({"--seconds", "3"});
  ProgramResult watch;
  std::thread watching([&watch] {
    watch = run_program("convexcut", {"watch", "--domain", domain(), "--seconds", "10", "--json"});
  });
  const ProgramResult run =
      run_daemon({"--lidar", lidar(), "--imu", imu(), "--wait-for-reader", "5"});
  watching.join();
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(watch.status, 0) << watch.err;  // 0: data came
  EXPECT_THAT(watch.out, HasSubstr("\"structure_hz\":"));
}

TEST_F(DaemonProgram, SigtermStopsItCleanly) {
  make_room({"--seconds", "30", "--empty"});
  ProgramLimits limits;
  limits.terminate_at = "info start";
  const ProgramResult run = run_daemon({"--lidar", lidar(), "--imu", imu()}, limits);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("info stop signal=SIGTERM"));
  EXPECT_THAT(run.err, HasSubstr("info end"));
}

TEST_F(DaemonProgram, AMissingRecordingIsOneLineAndExitStatusOne) {
  const ProgramResult run =
      run_daemon({"--lidar", path("none.pcap").string(), "--set", "mount.orientation=fixed"});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.error_lines(), 1U) << run.err;
}

TEST_F(DaemonProgram, ARecordingWithoutOrientationsFailsAtTheEnd) {
  make_room({"--seconds", "0.3"});
  write(path("noise.bin"), std::string(10'000, 'n'));
  const ProgramResult run =
      run_daemon({"--lidar", lidar(), "--imu", path("noise.bin").string(), "--rate", "max"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.err, HasSubstr("no orientation in it"));
}

TEST_F(DaemonProgram, AWrongConfigurationStopsTheStart) {
  make_room({"--seconds", "0.1"});
  const ProgramResult run = run_daemon({"--lidar", lidar(), "--set", "worker.period_ms=soon"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, HasSubstr("worker.period_ms"));
}

TEST_F(DaemonProgram, ALatencyTooShortForLearningFirstIsToldAtTheStart) {
  make_room({"--seconds", "0.3", "--empty"});
  const auto warned = [&](const std::string& latency_ms) {
    const ProgramResult run =
        run_daemon({"--lidar", lidar(), "--imu", imu(), "--rate", "max", "--set",
                    "convex_cut.method=robust", "--set", "worker.latency_ms=" + latency_ms});
    EXPECT_EQ(run.status, 0) << run.err;
    return run.err.find("set worker.latency_ms=40") != std::string::npos;
  };
  EXPECT_TRUE(warned("10"));
  EXPECT_FALSE(warned("40"));
}

TEST_F(DaemonProgram, ALidarPortInTheDdsDomainsRangeIsRefused) {
  make_room({"--seconds", "0.1"});
  const ProgramResult run = run_daemon({"--lidar", lidar(), "--set", "mount.orientation=fixed",
                                        "--set", "dds.domain=0", "--set", "lidar.data_port=7410"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, HasSubstr("7410"));
}

}  // namespace
}  // namespace convexcut::test
