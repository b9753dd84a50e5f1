// SPDX-License-Identifier: Apache-2.0
//
// The worker between its rings, with a source and a publisher on threads of their own. Does not
// prove anything about latency: nothing here depends on how fast it runs.
#include "daemon/worker.hpp"

#include <algorithm>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/clock/playback_clock.hpp"
#include "tests/core/scan/synthetic_lidar.hpp"

namespace convexcut::daemon {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr HostTime kStart = from_ns<HostTime>(1'700'000'000'000'000'000);
constexpr std::uint32_t kCountAtStart = 1'000'000'000;

struct Taken {
  std::uint64_t index;
  ScanEnd end;
  HostTime stamp;
  std::size_t points;
};

class WorkerTest : public ::testing::Test {
 protected:
  static constexpr double kAsFastAsPossible = 0.0;

  WorkerTest() {
    reserve_slots(results, Pipeline::kMaxReturnsPerScan);
    synthetic.start = LidarTime{};
    synthetic.returns_per_firing = 2;
    clock.start(kStart);
  }

  [[nodiscard]] static PipelineOptions pipeline_options() {
    PipelineOptions options;
    options.fixed_mount = true;
    return options;
  }

  // The source thread of a recording: waits for room, loses nothing.
  void play(Duration span) {
    for (std::int64_t i = 0; i < synthetic.packets_in(span) && !stop; ++i) {
      while (lidar.size_approx() + 1 > lidar.capacity() && !stop) std::this_thread::yield();
      ReturnBatch* slot = lidar.claim();
      if (slot == nullptr) continue;
      *slot = synthetic.packet(i).batch;
      const Duration elapsed = synthetic.time(i) - LidarTime{};
      slot->first_firing = {static_cast<std::uint32_t>(kCountAtStart + elapsed.count() / 1000)};
      slot->arrival = kStart + elapsed + slot->span();
      lidar.commit();
      clock.delivered(kStart + elapsed);
    }
    lidar_ended.store(true, std::memory_order_release);  // pairs with Worker::run
  }

  // The publisher thread: takes results until the worker is done.
  void collect() {
    for (;;) {
      const bool done = worker_done.load(std::memory_order_acquire);
      const auto take = [this](Result& result) noexcept { keep(result); };
      if (results.consume(take) == 0) {
        if (done) return;
        std::this_thread::yield();
      }
    }
  }

  void keep(const Result& result) {
    const LevelledScan& scan = result.scan;
    taken.push_back({scan.index, scan.end, scan.stamp, scan.size()});
  }

  void run(Worker& worker, Duration span) {
    std::thread source([this, span] { play(span); });
    std::thread publisher([this] { collect(); });
    worker.run(stop, lidar_ended, imu_ended);
    worker_done.store(true, std::memory_order_release);  // pairs with collect()
    source.join();
    publisher.join();
  }

  std::atomic<bool> stop{false};
  std::atomic<bool> lidar_ended{false};
  std::atomic<bool> imu_ended{true};
  std::atomic<bool> worker_done{false};
  PlaybackClock clock{kAsFastAsPossible, stop};
  SpscRing<ReturnBatch> lidar{256};
  SpscRing<ImuSample> imu{16};
  SpscRing<EncoderSample> encoder{64};
  ResultRing results{4};
  test::SyntheticLidar synthetic;
  std::vector<Taken> taken;
};

TEST_F(WorkerTest, HandsOverEveryRevolutionOfARecordingInOrder) {
  Worker worker(pipeline_options(), {}, clock, lidar, imu, encoder, results);
  run(worker, seconds{3});
  ASSERT_EQ(taken.size(), 30U);
  for (std::size_t i = 0; i < taken.size(); ++i) {
    EXPECT_EQ(taken[i].index, i);
    if (i > 0) {
      EXPECT_GT(taken[i].stamp, taken[i - 1].stamp);
    }
    if (i > 0 && i + 1 < taken.size()) {
      EXPECT_NEAR(static_cast<double>(taken[i].points), 2170.0 * 2, 4.0);
    }
  }
  EXPECT_EQ(worker.counters().scans.value(), 30U);
  EXPECT_EQ(worker.counters().dropped_scans.value(), 0U);
  EXPECT_EQ(worker.packets().lost.value(), 0U);
  EXPECT_EQ(lidar.overruns(), 0U);
}

TEST_F(WorkerTest, AShortRecordingGivesItsOneScan) {
  Worker worker(pipeline_options(), {}, clock, lidar, imu, encoder, results);
  run(worker, milliseconds{20});
  ASSERT_EQ(taken.size(), 1U);
  EXPECT_EQ(taken[0].end, ScanEnd::end_of_input);
}

TEST_F(WorkerTest, ReturnsOnStopWhileTheInputGoesOn) {
  Worker worker(pipeline_options(), {}, clock, lidar, imu, encoder, results);
  std::thread stopper([this] {
    while (results.size_approx() == 0) std::this_thread::yield();
    stop.store(true);
  });
  run(worker, seconds{3600});
  stopper.join();
  EXPECT_FALSE(taken.empty());
}

TEST_F(WorkerTest, AnglesOfAStageReachThePipeline) {
  PipelineOptions options = pipeline_options();
  options.stage_use = StageUse::orientation;
  for (Duration t = milliseconds{-50}; t <= milliseconds{1050}; t += milliseconds{50}) {
    EncoderSample* slot = encoder.claim();
    ASSERT_NE(slot, nullptr);
    *slot = {.arrival = kStart + t, .angle = {0.5}};
    encoder.commit();
  }
  Worker worker(options, {}, clock, lidar, imu, encoder, results);
  run(worker, seconds{1});
  ASSERT_EQ(taken.size(), 10U);
  EXPECT_GT(taken[5].points, 4000U);
  EXPECT_EQ(worker.counters().dropped_no_orientation.value(), 0U);
}

// A sensor that is silent, on a clock that runs.
TEST_F(WorkerTest, ASilentSensorStillGivesEmptyFlaggedResults) {
  PlaybackClock fast(20.0, stop);  // 100 ms of the grid pass in 5 ms
  fast.start(kStart);
  Worker worker(pipeline_options(), {}, fast, lidar, imu, encoder, results);
  std::thread publisher([this] {
    while (taken.size() < 5) {
      results.consume([this](Result& result) noexcept { keep(result); });
      std::this_thread::yield();
    }
    stop.store(true);
  });
  worker.run(stop, lidar_ended, imu_ended);
  publisher.join();
  for (const Taken& result : taken) {
    EXPECT_EQ(result.end, ScanEnd::no_data);
    EXPECT_EQ(result.points, 0U);
  }
  EXPECT_EQ(taken[0].index, 0U);
  EXPECT_EQ(taken[4].index, 4U);
  EXPECT_GE(worker.counters().empty_results.value(), 5U);
}

}  // namespace
}  // namespace convexcut::daemon
