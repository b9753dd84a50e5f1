// SPDX-License-Identifier: Apache-2.0
//
// What runs in the worker allocates nothing once it is made. Does not see memory that is mapped by
// other means than operator new.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/clock/clock_mapping.hpp"
#include "core/clock/hour_clock.hpp"
#include "core/scan/levelling.hpp"
#include "core/scan/orientation_track.hpp"
#include "core/scan/packet_sequencer.hpp"
#include "core/scan/scan_cutter.hpp"
#include "tests/core/scan/synthetic_lidar.hpp"
#include "tests/support/allocations.hpp"

namespace convexcut {
namespace {

using namespace std::chrono_literals;

TEST(Allocation, CounterSeesAnAllocation) {
  const std::uint64_t before = test::allocations();
  std::vector<int> some(100);
  EXPECT_GT(test::allocations(), before);
  EXPECT_EQ(some.size(), 100U);
}

TEST(Allocation, FromDatagramToLevelledScanThereIsNone) {
  constexpr std::size_t kReturns = 80'000, kFirings = 2'500;
  test::SyntheticLidar lidar;
  HourClock hour_clock;
  ClockMapping<LidarTime> mapping;
  PacketSequencer sequencer;
  OrientationTrack track(256);
  ScanCutter cutter({}, kReturns, kFirings);
  Scan spare;
  reserve(spare, kReturns, kFirings);
  LevelledScan levelled;
  reserve(levelled, kReturns);
  std::size_t points = 0;

  const auto on_scan = [&](Scan& scan) {
    std::swap(scan, spare);
    level(spare, mapping.to_host(spare.first_firing), track, Quaternion::Identity(), levelled);
    points += levelled.size();
  };
  const auto into_cutter = [&](const ReturnBatch& batch, LidarTime first_firing) {
    cutter.push(batch, first_firing, on_scan);
  };

  const std::uint64_t before = test::allocations();
  for (std::int64_t n = 0; n < 900; ++n) {
    const std::int64_t packet = n ^ 1;  // every pair swapped
    const test::TimedBatch timed = lidar.packet(packet);
    const HostTime arrival{lidar.time(packet).time_since_epoch() + 1ms};
    const MicrosPastHour counter{
        static_cast<std::uint32_t>(to_ns(lidar.time(packet)) / 1000 % 3'600'000'000)};
    const LidarTime time = hour_clock.unwrap(counter, arrival);
    mapping.observe(time, arrival);
    track.push(arrival, Quaternion::Identity());
    sequencer.push(timed.batch, time, into_cutter);
  }
  sequencer.flush(into_cutter);
  cutter.finish(on_scan);
  EXPECT_EQ(test::allocations(), before);
  EXPECT_GT(points, 300'000U);
}

}  // namespace
}  // namespace convexcut
