// SPDX-License-Identifier: Apache-2.0
//
// `convexcut replay` into the live sources of a daemon, over loopback and a terminal. Does not
// prove how exactly records are paced on a loaded machine, nor anything about CAN, which needs a
// kernel that has it (tests/vm).
#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "daemon/sources/live_sources.hpp"
#include "drivers/capture/capture_reader.hpp"
#include "drivers/live/host_clock.hpp"
#include "tests/drivers/velodyne/collecting_sink.hpp"
#include "tests/drivers/xsens/recording_sink.hpp"
#include "tests/support/room.hpp"
#include "tests/support/udp_sender.hpp"

namespace convexcut::test {
namespace {

using ::testing::HasSubstr;

// Keeps the bytes of every record.
class ByteTap final : public live::RawTap {
 public:
  void on_record(const capture::Record& record) noexcept override {
    records.push_back(text_of(record.payload));
  }
  static std::string text_of(wire::Bytes bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  std::vector<std::string> records;
};

class Replay : public RoomTest {
 protected:
  void SetUp() override {
    make_room({"--seconds", "0.6", "--empty"});
    config_.lidar.model = config::LidarModel::hdl32e;
    config_.lidar.data_port = free_udp_port();
    config_.lidar.position_port = free_udp_port();
    config_.mount.orientation = config::MountOrientation::fixed;
    config_.imu.device = path("imu");
    imu_file_ = imu();
  }

  // Runs the program and receives what it sends; when it has ended and nothing comes any more,
  // everything is here.
  void play(std::vector<std::string> arguments, bool with_imu = true) {
    if (!with_imu) config_.imu.device.clear();
    live_.emplace(config_, returns_, samples_, angles_, daemon::LiveTaps{.lidar = &tap_});
    receive(std::chrono::milliseconds{1});
    const auto port = [](std::uint16_t number) { return std::to_string(number); };
    std::vector<std::string> all{
        "replay", "--lidar",
        lidar(),  "--json",
        "--set",  "lidar.data_port=" + port(config_.lidar.data_port),
        "--set",  "lidar.position_port=" + port(config_.lidar.position_port)};
    if (with_imu) {
      all.insert(all.end(), {"--imu", imu_file_, "--imu-link", config_.imu.device, "--wait", "20"});
    }
    all.insert(all.end(), arguments.begin(), arguments.end());
    std::atomic<bool> ended{false};
    std::thread program([&] {
      result_ = run_program("convexcut", all);
      ended.store(true);
    });
    while (!ended.load()) receive(std::chrono::milliseconds{2});
    program.join();
    receive(std::chrono::milliseconds{2});
    ASSERT_EQ(result_.status, 0) << result_.err;
  }

  [[nodiscard]] std::uint64_t figure(const std::string& key) const {
    const std::size_t at = result_.out.find("\"" + key + "\":");
    EXPECT_NE(at, std::string::npos) << key << " in " << result_.out;
    return at == std::string::npos ? 0 : std::stoull(result_.out.substr(at + key.size() + 3));
  }
  [[nodiscard]] const velodyne::LidarCounters& lidar_counters() const {
    return live_->lidar_driver().counters();
  }
  [[nodiscard]] const xsens::ImuCounters& imu_counters() const {
    return live_->imu_driver()->counters();
  }

  // The data and position packets of the recording, in order.
  [[nodiscard]] std::vector<std::string> recorded() const {
    std::vector<std::string> payloads;
    capture::CaptureReader reader(lidar());
    capture::Record record;
    while (reader.next(record) == capture::ReadStatus::record) {
      payloads.push_back(ByteTap::text_of(record.payload));
    }
    return payloads;
  }

  std::string imu_file_;
  config::Config config_;
  velodyne::test::CollectingSink returns_;
  RecordingSink samples_;
  daemon::NullSink<EncoderSample> angles_;
  ByteTap tap_;
  std::optional<daemon::LiveSources> live_;
  ProgramResult result_;

 private:
  void receive(Duration wait) {
    for (const daemon::LiveSources::Entry& entry : live_->entries()) entry.source.receive(wait);
  }
};

TEST_F(Replay, EveryRecordArrivesOnce) {
  play({});
  EXPECT_GT(figure("data_packets"), 1000U);
  EXPECT_EQ(lidar_counters().data_packets.value(), figure("data_packets"));
  EXPECT_EQ(lidar_counters().position_packets.value(), figure("position_packets"));
  EXPECT_EQ(figure("datagrams_sent"), recorded().size());
  EXPECT_GT(figure("imu_sent"), 50U);
  EXPECT_EQ(figure("imu_unheard"), 0U);
  EXPECT_EQ(imu_counters().data_messages.value(), figure("imu_sent"));
  EXPECT_EQ(imu_counters().xbus.skipped_bytes.value(), 0U);
  EXPECT_EQ(live_->kernel_drops(), 0U);
}

TEST_F(Replay, PacketsAreThoseOfTheRecordingByteByByte) {
  play({}, false);
  auto sent = recorded();
  auto heard = tap_.records;
  std::sort(sent.begin(), sent.end());  // the two ports are received side by side
  std::sort(heard.begin(), heard.end());
  EXPECT_TRUE(sent == heard);
}

TEST_F(Replay, SensorsTimesAndCountersGoOnWhenItIsPlayedAgain) {
  play({"--times", "3"});
  EXPECT_EQ(figure("times"), 3U);
  EXPECT_EQ(lidar_counters().data_packets.value(), figure("data_packets"));
  EXPECT_NEAR(static_cast<double>(figure("datagrams_sent")),
              static_cast<double>(3 * recorded().size()), 2.0);  // position packets at the seams
  const auto& batches = returns_.batches;
  for (std::size_t i = 1; i < batches.size(); ++i) {
    const std::uint32_t step =
        (batches[i].first_firing.count + 3'600'000'000U - batches[i - 1].first_firing.count) %
        3'600'000'000U;
    // One packet's time, to a tick of the IMU where the recording begins again.
    ASSERT_GE(step, 452U) << i;
    ASSERT_LE(step, 653U) << i;
  }
  EXPECT_EQ(imu_counters().lost_messages.value(), 0U);
  EXPECT_EQ(imu_counters().counter_restarts.value(), 0U);
  const auto& samples = samples_.samples;
  ASSERT_GT(samples.size(), 150U);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const Duration step = samples[i].device_time - samples[i - 1].device_time;
    ASSERT_GT(step, Duration{0}) << i;
    ASSERT_LE(step, std::chrono::milliseconds{25}) << i;  // of 10
  }
}

TEST_F(Replay, SensorsClocksRunAtOneSecondASecondAtAnyRate) {
  play({"--rate", "2"});
  const auto& batches = returns_.batches;
  ASSERT_GT(batches.size(), 1000U);
  EXPECT_EQ(lidar_counters().data_packets.value(), figure("data_packets"));
  const std::uint32_t span =
      (batches.back().first_firing.count + 3'600'000'000U - batches.front().first_firing.count) %
      3'600'000'000U;
  EXPECT_NEAR(span, static_cast<double>(batches.size() - 1) * 552.96 / 2, 1000.0);
  const auto& samples = samples_.samples;
  ASSERT_GT(samples.size(), 50U);
  const Duration imu_span = samples.back().device_time - samples.front().device_time;
  const Duration step = samples[1].device_time - samples[0].device_time;
  EXPECT_EQ(step, std::chrono::milliseconds{5});  // of 10 at 100 Hz
  EXPECT_EQ(imu_span, step * static_cast<std::int64_t>(samples.size() - 1));
}

TEST_F(Replay, PartIsPlayed) {
  play({"--from", "0.2", "--to", "0.5"}, false);
  const std::uint64_t packets = lidar_counters().data_packets.value();
  EXPECT_EQ(packets, figure("data_packets"));
  EXPECT_NEAR(static_cast<double>(packets), 0.3 * 1808.45, 3.0);
}

TEST_F(Replay, LostPacketsAreMissingAndCounted) {
  play({"--loss", "0.1"});
  const std::uint64_t all = recorded().size();
  EXPECT_EQ(figure("datagrams_sent") + figure("datagrams_lost"), all);
  EXPECT_NEAR(static_cast<double>(figure("datagrams_lost")), 0.1 * static_cast<double>(all), 60.0);
  EXPECT_EQ(tap_.records.size(), figure("datagrams_sent"));
  EXPECT_GT(figure("imu_lost"), 0U);
  EXPECT_EQ(imu_counters().data_messages.value(), figure("imu_sent"));
}

TEST_F(Replay, DuplicatesReorderingAndDelayLoseNothing) {
  play({"--duplicate", "0.1", "--reorder", "0.1", "--delay", "3"}, false);
  EXPECT_EQ(figure("datagrams_sent"), recorded().size() + figure("datagrams_duplicated"));
  EXPECT_GT(figure("datagrams_duplicated"), 50U);
  EXPECT_GT(figure("datagrams_reordered"), 50U);
  EXPECT_EQ(tap_.records.size(), figure("datagrams_sent"));
  std::uint64_t backward = 0;
  std::uint64_t repeated = 0;
  for (std::size_t i = 1; i < returns_.batches.size(); ++i) {
    const auto step = static_cast<std::int32_t>(returns_.batches[i].first_firing.count -
                                                returns_.batches[i - 1].first_firing.count);
    if (step < 0) ++backward;
    if (step == 0) ++repeated;
  }
  EXPECT_GT(backward, 0U);
  EXPECT_GT(repeated, 0U);
}

TEST_F(Replay, GarbageIsRefusedAndThePacketsAreNot) {
  play({"--garbage", "0.2"});
  EXPECT_EQ(lidar_counters().data_packets.value(), figure("data_packets"));
  EXPECT_GT(figure("datagrams_garbage"), 100U);
  EXPECT_EQ(tap_.records.size(), figure("datagrams_sent") + figure("datagrams_garbage"));
  EXPECT_GT(figure("imu_garbage"), 5U);
  EXPECT_GT(imu_counters().xbus.skipped_bytes.value(), 0U);
}

TEST_F(Replay, SameSeedGivesTheSameFaults) {
  const std::vector<std::string> faults{"--loss",    "0.05", "--reorder", "0.05",
                                        "--garbage", "0.05", "--seed",    "7"};
  play(faults, false);
  const auto first = tap_.records;
  tap_.records.clear();
  play(faults, false);
  auto second = tap_.records;
  ASSERT_EQ(first.size(), second.size());
  auto sorted = first;
  std::sort(sorted.begin(), sorted.end());
  std::sort(second.begin(), second.end());
  EXPECT_TRUE(sorted == second);
}

TEST_F(Replay, StallIsSilenceOfAllSensors) {
  play({"--stall", "0.1", "--stall-every", "0.3"}, false);
  EXPECT_NEAR(static_cast<double>(figure("stalled")), 2 * 0.1 * 2009.0, 30.0);
  EXPECT_EQ(figure("datagrams_sent") + figure("stalled"), recorded().size());
  EXPECT_EQ(tap_.records.size(), figure("datagrams_sent"));
}

TEST_F(Replay, UnpluggedImuIsOpenedAgainAndHeardAgain) {
  make_room({"--seconds", "2.5", "--empty"});
  play({"--unplug-imu", "0.5", "--unplugged-for", "0.3"});
  EXPECT_EQ(live_->imu()->counters().unplugged.value(), 2U);  // by the fault and at the end
  EXPECT_EQ(live_->imu()->counters().opened.value(), 2U);
  EXPECT_GT(figure("imu_unheard"), 20U);
  // What was on the line when the plug was pulled is gone too: the IMU's own count tells of all.
  EXPECT_LE(imu_counters().data_messages.value(), figure("imu_sent"));
  EXPECT_GE(imu_counters().lost_messages.value(), figure("imu_unheard"));
  EXPECT_EQ(imu_counters().data_messages.value() + imu_counters().lost_messages.value(),
            figure("imu_sent") + figure("imu_unheard"));
  EXPECT_EQ(lidar_counters().data_packets.value(), figure("data_packets"));
}

TEST_F(Replay, RawStreamIsPacedByTheDevicesTime) {
  CONVEXCUT_NEEDS_RECORDING(raw, "imu/mti_g710_1.bin");
  imu_file_ = raw;
  play({});
  EXPECT_EQ(figure("imu_sent") + figure("imu_unheard"), 100U);
  EXPECT_EQ(imu_counters().data_messages.value(), figure("imu_sent"));
}

TEST_F(Replay, ImuAnswersAHostThatConfiguresIt) {
  config_.imu.configure = true;
  config_.imu.set_baud = 921600;
  play({});
  const xsens::MtConfiguration& device = *live_->imu()->configuration();
  EXPECT_EQ(device.counters().completed.value(), 1U);
  EXPECT_EQ(device.outcome(), xsens::MtOutcome::as_wanted);
  EXPECT_EQ(device.baud(), 921600U);
  EXPECT_GT(figure("imu_sent"), 50U);
  EXPECT_EQ(imu_counters().data_messages.value(), figure("imu_sent"));
}

TEST_F(Replay, SigtermEndsItWithItsSummary) {
  ProgramLimits limits;
  limits.terminate_at = "/dev/pts/";
  const ProgramResult run = run_program("convexcut", {"replay", "--imu", imu(), "--loop"}, limits);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("ended by a signal"));
}

TEST_F(Replay, WrongUsageIsOneLineAndExitStatusTwo) {
  const std::vector<std::vector<std::string>> wrong{
      {},
      {"--lidar", lidar(), "--from", "2", "--to", "1"},
      {"--lidar", lidar(), "--rate", "0"},
      {"--lidar", lidar(), "--loss", "1.5"},
      {"--lidar", lidar(), "--stall", "20"},
      {"--lidar", lidar(), "--loop", "--times", "2"}};
  for (std::vector<std::string> arguments : wrong) {
    arguments.insert(arguments.begin(), "replay");
    const ProgramResult run = run_program("convexcut", arguments);
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_EQ(run.error_lines(), 1U) << run.err;
  }
}

TEST_F(Replay, WhatCannotBePlayedIsOneLineAndExitStatusOne) {
  write(path("noise.bin"), std::string(5000, 'n'));
  const std::vector<std::vector<std::string>> wrong{
      {"--lidar", path("none.pcap")},
      {"--lidar", imu()},
      {"--imu", lidar()},
      {"--imu", path("noise.bin")},
      {"--lidar", lidar(), "--to-address", "nowhere"},
      {"--lidar", lidar(), "--from", "100"},
      {"--lidar", lidar(), "--can", can(), "--can-interface", "nocan0"},
      {"--imu", imu(), "--imu-link", lidar()}};
  for (std::vector<std::string> arguments : wrong) {
    arguments.insert(arguments.begin(), "replay");
    const ProgramResult run = run_program("convexcut", arguments);
    EXPECT_EQ(run.status, 1) << arguments.back() << ": " << run.err;
    EXPECT_EQ(run.error_lines(), 1U) << run.err;
  }
}

}  // namespace
}  // namespace convexcut::test
