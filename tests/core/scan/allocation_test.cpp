// SPDX-License-Identifier: Apache-2.0
//
// What runs in the worker allocates nothing once it is made. Counts the global operator new, so it
// is a program of its own; it does not see memory that is mapped by other means.
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
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

namespace {
std::atomic<std::uint64_t> g_allocations{0};
}  // namespace

void* operator new(std::size_t size) {
  ++g_allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++g_allocations;
  const auto align = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(align, (size + align - 1) / align * align)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace convexcut {
namespace {

using namespace std::chrono_literals;

TEST(Allocation, CounterSeesAnAllocation) {
  const std::uint64_t before = g_allocations;
  std::vector<int> some(100);
  EXPECT_GT(g_allocations, before);
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

  const std::uint64_t before = g_allocations;
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
  EXPECT_EQ(g_allocations, before);
  EXPECT_GT(points, 300'000U);
}

}  // namespace
}  // namespace convexcut
