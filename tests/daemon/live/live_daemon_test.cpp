// SPDX-License-Identifier: Apache-2.0
//
// convexcutd live: real UDP, a real terminal, real DDS between processes. Does not prove anything
// about latency or jitter (tests/soak.sh and tests/latency.sh measure these), nor about a real
// sensor's timing.
#include "tests/daemon/live/live_daemon.hpp"

#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "tests/support/sanitized.hpp"
#include "tests/support/tcp_client.hpp"
#include "tests/support/udp_sender.hpp"

namespace convexcut::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

TEST_F(LiveDaemon, TakesALidarAndAnImuAndLosesNothing) {
  make_room({"--seconds", "4"});
  const std::string link = path("imu").string();
  BackgroundProgram replay(
      "convexcut", with(replay_of_lidar(), {"--imu", imu(), "--imu-link", link, "--wait", "20"}));
  while (!std::filesystem::exists(link)) std::this_thread::sleep_for(milliseconds{10});
  start_daemon({"imu.device=" + link});
  std::this_thread::sleep_for(seconds{6});
  const ProgramResult sent = replay.stop();
  const ProgramResult run = daemon_->stop();

  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(logged(run.err, "info end", "packets"), counted(sent.out, "data_packets")) << run.err;
  EXPECT_EQ(logged(run.err, "info end", "lost_packets"), 0);
  EXPECT_EQ(logged(run.err, "info end", "lost_imu_samples"), 0);
  EXPECT_GT(logged(run.err, "info end", "imu_samples"), 300);
  // Scans, and empty results before and after.
  EXPECT_GT(logged(run.err, "info end", "scans"), logged(run.err, "info end", "empty") + 35);
}

TEST_F(LiveDaemon, TellsHowItIsOverHttpAndOnASignal) {
  make_room({"--seconds", "2", "--empty"});
  const std::uint16_t port = free_udp_port();  // free for TCP too, unless others take it
  start_daemon({"mount.orientation=fixed", "metrics.port=" + std::to_string(port)});
  const auto metrics = [port] {
    const TcpClient client(port);
    client.send("GET /metrics HTTP/1.0\r\n\r\n");
    return client.receive();
  };
  const auto becomes = [&](const std::string& line) {
    std::string answer;
    for (int i = 0; i < 300; ++i) {
      answer = metrics();
      if (answer.find(line) != std::string::npos) return answer;
      std::this_thread::sleep_for(milliseconds{100});
    }
    return answer;
  };
  EXPECT_THAT(becomes(R"(convexcut_source_state{source="lidar",state="waiting"} 1)"),
              HasSubstr(R"(source="lidar",state="waiting"} 1)"));
  BackgroundProgram replay("convexcut", with(replay_of_lidar(), {"--loop"}));
  const std::string streaming =
      becomes(R"(convexcut_source_state{source="lidar",state="streaming"} 1)");
  EXPECT_THAT(streaming, HasSubstr(R"(source="lidar",state="streaming"} 1)"));
  std::this_thread::sleep_for(seconds{2});
  daemon_->send(SIGUSR1);
  EXPECT_TRUE(daemon_->wait_for("health_stage name=cut count="));
  EXPECT_GT(logged(daemon_->err(), "info health_stage name=cut", "count"), 5);
  EXPECT_GT(logged(daemon_->err(), "info health_stage name=arrival_to_ring", "count"), 1000);
  EXPECT_EQ(replay.stop().status, 0);
  EXPECT_THAT(becomes(R"(convexcut_source_state{source="lidar",state="stale"} 1)"),
              HasSubstr(R"(source="lidar",state="stale"} 1)"));
  const ProgramResult run = daemon_->stop();
  EXPECT_EQ(run.status, 0) << run.err;
}

TEST_F(LiveDaemon, WithoutASensorItRunsAndStopsCleanly) {
  start_daemon({"mount.orientation=fixed"});
  std::this_thread::sleep_for(seconds{2});
  const ProgramResult run = daemon_->stop();
  EXPECT_EQ(run.status, 0) << run.err;
  const long results = logged(run.err, "info timing", "results");
  const long run_ms = logged(run.err, "info timing", "run_ms");
  EXPECT_NEAR(static_cast<double>(results), static_cast<double>(run_ms) / 100.0, 2.0);
  EXPECT_NEAR(static_cast<double>(logged(run.err, "info end", "empty")),
              static_cast<double>(results), 1.0);
}

// Twenty times the packets that the sensor sends: what cannot be taken is counted, to the packet.
TEST_F(LiveDaemon, EveryPacketOfAnOverloadIsDecodedOrCounted) {
  make_room({"--seconds", "2", "--empty"});
  start_daemon({"mount.orientation=fixed"});
  becomes("lidar", "waiting", 10.0);  // its ports are open: it hears the first packet
  BackgroundProgram replay("convexcut", with(replay_of_lidar(), {"--rate", "20", "--loop"}));
  std::this_thread::sleep_for(seconds{10});
  const ProgramResult sent = replay.stop();
  std::this_thread::sleep_for(seconds{1});  // drops are counted a few times a second
  const ProgramResult run = daemon_->stop();

  EXPECT_EQ(run.status, 0) << run.err;
  const long packets = counted(sent.out, "datagrams_sent");
  EXPECT_GT(packets, 100'000);  // 36 000 a second, where the host keeps up with sending
  const long decoded =
      logged(run.err, "info end", "packets") + logged(run.err, "info end", "position_packets");
  const long kernel = logged(run.err, "info end", "kernel_drops");
  const long ring = logged(run.err, "info end", "ring_overruns");
  EXPECT_GT(decoded, 0);
  EXPECT_EQ(decoded + kernel + ring, packets) << run.err;
}

// A subscriber that is stopped: neither the worker nor the memory notices.
class StalledSubscriber : public LiveDaemon, public ::testing::WithParamInterface<const char*> {};

TEST_P(StalledSubscriber, HoldsUpNobody) {
  make_room({"--seconds", "16", "--empty"});
  start_daemon({"mount.orientation=fixed", std::string("dds.reliability=") + GetParam()});
  BackgroundProgram watch("convexcut", {"watch", "--domain", domain(), "--json"});
  BackgroundProgram replay("convexcut", replay_of_lidar());
  std::this_thread::sleep_for(seconds{3});
  const long before = resident_kib(daemon_->pid());
  watch.send(SIGSTOP);
  std::this_thread::sleep_for(seconds{10});
  const long after = resident_kib(daemon_->pid());
  watch.send(SIGCONT);
  std::this_thread::sleep_for(seconds{1});
  const ProgramResult run = daemon_->stop();

  EXPECT_EQ(run.status, 0) << run.err;
  const long results = logged(run.err, "info timing", "results");
  const long run_ms = logged(run.err, "info timing", "run_ms");
  EXPECT_NEAR(static_cast<double>(results), static_cast<double>(run_ms) / 100.0, 3.0) << run.err;
  EXPECT_EQ(logged(run.err, "info end", "lost_packets"), 0);
  EXPECT_EQ(logged(run.err, "info end", "ring_overruns"), 0);
  if (!kSanitized) {
    EXPECT_LT(after - before, 8 * 1024) << "KiB more while the subscriber was stopped";
  }
}

INSTANTIATE_TEST_SUITE_P(Qos, StalledSubscriber, ::testing::Values("reliable", "best_effort"),
                         [](const auto& test) { return std::string(test.param); });

// More planes than any host cuts in time, and not so many that one scan takes all of it.
TEST_F(LiveDaemon, LessIsComputedAndSaidWhenTimeIsShort) {
  make_room({"--seconds", "4", "--empty"});
  start_daemon({"mount.orientation=fixed", "convex_cut.method=paper",
                kSanitized ? "convex_cut.planes=6000" : "convex_cut.planes=36000"});
  BackgroundProgram replay("convexcut", replay_of_lidar());
  std::this_thread::sleep_for(seconds{4});
  const ProgramResult run = daemon_->stop();
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_GT(logged(run.err, "info timing", "reduced_scans"), kSanitized ? 0 : 10) << run.err;
  if (!kSanitized) {
    EXPECT_EQ(logged(run.err, "info end", "ring_overruns"), 0);
  }
}

TEST_F(LiveDaemon, AnImuWithoutALidarRecordingIsWrongUsage) {
  const ProgramResult run = run_program("convexcutd", {"--imu", "imu.pcap"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, HasSubstr("--lidar"));
}

}  // namespace
}  // namespace convexcut::test
