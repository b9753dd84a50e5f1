// SPDX-License-Identifier: Apache-2.0
//
// What goes wrong on an IMU's serial line, on convexcutd live as users run it. Does not prove
// anything about real adapters: the line is a pseudo-terminal.
#include <chrono>
#include <filesystem>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "drivers/capture/capture_reader.hpp"
#include "replay/emulator/pseudo_terminal.hpp"
#include "tests/daemon/live/live_fault.hpp"

namespace convexcut::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

TEST_F(LiveFault, ImuThatIsUnpluggedIsAbsentAndPluggedInAgainIsTaken) {
  make_room({"--seconds", "5", "--empty"});
  const std::string link = path("imu").string();
  BackgroundProgram replay(
      "convexcut", with(replay_of_lidar(), {"--imu", imu(), "--imu-link", link, "--wait", "20",
                                            "--unplug-imu", "2", "--unplugged-for", "1"}));
  while (!std::filesystem::exists(link)) std::this_thread::sleep_for(milliseconds{10});
  start_daemon({"imu.device=" + link});
  becomes("imu", "streaming", kRecovery);
  becomes("imu", "absent", 3.0);
  becomes("imu", "streaming", 1.0 + kRecovery);
  const ProgramResult sent = replay.stop();
  stop();
  EXPECT_LE(ended_with("imu_samples"), counted(sent.out, "imu_sent"));
  EXPECT_GT(ended_with("lost_imu_samples"), 50);
  // What was on the line when it broke is among the lost, by the device's own count.
  EXPECT_NEAR(static_cast<double>(ended_with("imu_samples") + ended_with("lost_imu_samples")),
              static_cast<double>(counted(sent.out, "imu_sent") + counted(sent.out, "imu_unheard")),
              3.0);
  EXPECT_EQ(ended_with("lost_packets"), 0) << "the lidar is not concerned";
  expect_results_all_the_time();
}

TEST_F(LiveFault, NoiseOnTheSerialLineIsCountedAndSamplesGoOn) {
  make_room({"--seconds", "4", "--empty"});
  const std::string link = path("imu").string();
  BackgroundProgram replay(
      "convexcut", with(replay_of_lidar(),
                        {"--imu", imu(), "--imu-link", link, "--wait", "20", "--garbage", "0.1"}));
  while (!std::filesystem::exists(link)) std::this_thread::sleep_for(milliseconds{10});
  start_daemon({"imu.device=" + link});
  becomes("imu", "streaming", kRecovery);
  std::this_thread::sleep_for(milliseconds{2500});
  const std::string now = dump();
  EXPECT_GT(logged(now, "info health_source name=imu", "invalid"), 10) << now;
  EXPECT_THAT(now, HasSubstr("health_source name=imu state=streaming"));
  const ProgramResult sent = replay.stop();
  stop();
  EXPECT_GT(counted(sent.out, "imu_garbage"), 10);
  // Noise may look like the beginning of a message and take the next one with it: that is lost.
  EXPECT_EQ(ended_with("imu_samples") + ended_with("lost_imu_samples"),
            counted(sent.out, "imu_sent"));
  EXPECT_LE(ended_with("lost_imu_samples"), counted(sent.out, "imu_garbage") / 4);
  expect_nothing_dropped_here();
}

// The recorded bytes of an MTi, brought to a terminal by this test.
class ImuByHand : public LiveFault {
 protected:
  using Clock = std::chrono::steady_clock;

  void start(const std::string& length_s) {
    make_room({"--seconds", length_s, "--empty"});
    reader_ = std::make_unique<capture::CaptureReader>(imu());
    more_ = reader_->next(record_) == capture::ReadStatus::record;
    ASSERT_TRUE(more_);
    first_ = record_.stamp;
    plug_in();
    start_daemon({"imu.device=" + link()});
    while (!terminal_->heard()) std::this_thread::sleep_for(milliseconds{5});
    replay_ = std::make_unique<BackgroundProgram>("convexcut", replay_of_lidar());
    start_ = Clock::now();
  }
  void plug_in() { terminal_ = std::make_unique<replay::PseudoTerminal>(link()); }
  void unplug() { terminal_.reset(); }
  [[nodiscard]] std::string link() const { return path("imu").string(); }

  // What the device has said since the last call, up to `elapsed`; nothing is heard while it is
  // not plugged in.
  std::vector<std::byte> said_until(Clock::duration elapsed) {
    std::vector<std::byte> bytes;
    while (more_ && record_.stamp - first_ <= elapsed) {
      bytes.insert(bytes.end(), record_.payload.begin(), record_.payload.end());
      more_ = reader_->next(record_) == capture::ReadStatus::record;
    }
    return bytes;
  }
  // Brings the bytes in batches until `end` after the start.
  void send_until(Clock::duration end, Clock::duration batch) {
    for (Clock::duration at = Clock::now() - start_; at < end; at += batch) {
      std::this_thread::sleep_until(start_ + at);
      const std::vector<std::byte> bytes = said_until(at);
      EXPECT_EQ(terminal_->send(bytes), bytes.size());
    }
  }
  // The same beside the test: the device goes on while the daemon is asked.
  [[nodiscard]] std::future<void> send_beside_until(Clock::duration end, Clock::duration batch) {
    return std::async(std::launch::async, [=, this] { send_until(end, batch); });
  }
  [[nodiscard]] long samples_recorded() const {
    return counted(run_program("convexcut", {"info", "--json", "--imu", imu()}).out, "samples");
  }

  std::unique_ptr<replay::PseudoTerminal> terminal_;
  std::unique_ptr<capture::CaptureReader> reader_;
  std::unique_ptr<BackgroundProgram> replay_;
  capture::Record record_;
  HostTime first_{};
  Clock::time_point start_{};
  bool more_ = false;
};

// As an FTDI adapter does whose latency timer was left alone.
TEST_F(ImuByHand, BytesInBatchesOf16MillisecondsLoseNoSampleAndNoPoint) {
  start("3");
  const std::future<void> sent = send_beside_until(milliseconds{3800}, milliseconds{16});
  std::this_thread::sleep_until(start_ + milliseconds{1200});
  const std::string before = dump();
  std::this_thread::sleep_until(start_ + milliseconds{2600});
  const std::string after = dump();
  sent.wait();
  EXPECT_THAT(after, HasSubstr("health_source name=imu state=streaming"));
  EXPECT_THAT(after, HasSubstr("health_source name=lidar state=streaming"));
  EXPECT_EQ(logged(after, "info health_totals", "points_without_orientation"),
            logged(before, "info health_totals", "points_without_orientation"));
  EXPECT_EQ(replay_->stop().status, 0);
  stop();
  EXPECT_EQ(ended_with("imu_samples"), samples_recorded());
  EXPECT_EQ(ended_with("lost_imu_samples"), 0);
  EXPECT_GE(scans(), 25);
  expect_results_all_the_time();
}

TEST_F(ImuByHand, LineThatBreaksWithinAMessageLosesThatMessageAndGoesOnWhenItIsBack) {
  start("3");
  send_until(milliseconds{1200}, milliseconds{10});
  const std::vector<std::byte> message = said_until(milliseconds{1250});
  ASSERT_GT(message.size(), 20U);
  EXPECT_EQ(terminal_->send(std::span(message).first(message.size() - 10)), message.size() - 10);
  std::this_thread::sleep_for(milliseconds{20});  // it is read before the line breaks
  unplug();
  becomes("imu", "absent", 2.0);
  static_cast<void>(said_until(Clock::now() - start_));
  plug_in();
  while (!terminal_->heard()) {
    ASSERT_LT(Clock::now() - start_, seconds{10});
    std::this_thread::sleep_for(milliseconds{10});
    static_cast<void>(said_until(Clock::now() - start_));
  }
  const Clock::duration back = Clock::now() - start_;
  send_until(back + milliseconds{300}, milliseconds{10});
  const std::future<void> sent = send_beside_until(milliseconds{3800}, milliseconds{10});
  becomes("imu", "streaming", 1.0);
  sent.wait();
  EXPECT_EQ(replay_->stop().status, 0);
  stop();
  // Whole messages are either taken or lost.
  EXPECT_GT(ended_with("lost_imu_samples"), 5);
  EXPECT_EQ(ended_with("imu_samples") + ended_with("lost_imu_samples"), samples_recorded());
  EXPECT_EQ(ended_with("lost_packets"), 0) << "the lidar is not concerned";
  expect_results_all_the_time();
}

}  // namespace
}  // namespace convexcut::test
