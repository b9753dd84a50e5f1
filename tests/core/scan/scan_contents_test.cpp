// SPDX-License-Identifier: Apache-2.0
//
// What of a firing gets into a scan: range gate, echoes, capacity. Does not prove that the driver
// tags the echoes rightly.
#include <chrono>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scan/scan_cutter.hpp"
#include "tests/core/scan/cutting.hpp"
#include "tests/core/scan/synthetic_lidar.hpp"

namespace convexcut {
namespace {

using namespace std::chrono_literals;
using test::Cutting;
using test::kFirstPacket;
using test::packet_of;
using test::SyntheticLidar;
using test::TimedBatch;
using testing::ElementsAre;

TEST(ScanContents, RangeGateIncludesItsBounds) {
  CutOptions options;
  options.min_range_m = 0.5;
  options.max_range_m = 100.0;
  Cutting cut(options);
  TimedBatch timed = packet_of({100}, kFirstPacket, 5);
  timed.batch.range_m[0] = 0.498F;
  timed.batch.range_m[1] = 0.5F;
  timed.batch.range_m[2] = 50.0F;
  timed.batch.range_m[3] = 100.0F;
  timed.batch.range_m[4] = 100.002F;
  cut.push(timed);
  cut.finish();
  EXPECT_THAT(cut.scans[0].ring, ElementsAre(1, 2, 3));
  EXPECT_EQ(cut.scans[0].firings[0].return_count, 3U);
}

TEST(ScanContents, EchoesAreSelected) {
  using Echoes = CutOptions::Echoes;
  // Ring 0: a single echo. Ring 1: the last is the farther. Ring 2: a strongest that is farther
  // than what the sensor calls last.
  TimedBatch timed = packet_of({100}, kFirstPacket, 5);
  ReturnBatch& batch = timed.batch;
  batch.ring = {0, 1, 1, 2, 2};
  batch.echo = {Echo::only, Echo::last, Echo::strongest, Echo::last, Echo::strongest};
  batch.farthest = {true, true, false, false, true};
  const auto picked = [&](Echoes echoes) {
    CutOptions options;
    options.echoes = echoes;
    Cutting cut(options);
    cut.push(timed);
    cut.finish();
    return cut.scans[0].y_lidar;  // the index in the batch
  };
  EXPECT_THAT(picked(Echoes::farthest), ElementsAre(0, 1, 4));
  EXPECT_THAT(picked(Echoes::last), ElementsAre(0, 1, 3));
  EXPECT_THAT(picked(Echoes::strongest), ElementsAre(0, 2, 4));
  EXPECT_THAT(picked(Echoes::both), ElementsAre(0, 1, 2, 3, 4));
}

TEST(ScanContents, ScanWithoutAnyReturnIsAScan) {
  SyntheticLidar lidar;
  lidar.returns_per_firing = 0;
  Cutting cut;
  cut.push(lidar, 0, lidar.packets_in(150ms));
  ASSERT_EQ(cut.scans.size(), 1U);
  EXPECT_EQ(cut.scans[0].size(), 0U);
  EXPECT_EQ(cut.scans[0].coverage(), 1.0);
}

TEST(ScanContents, ReturnsAreCopiedWithTheirTimeAfterTheFirstFiring) {
  Cutting cut;
  cut.push(packet_of({35985, 0}, kFirstPacket, 2));
  cut.push(packet_of({15}, kFirstPacket + 92us, 2, 2));
  cut.finish();
  const Scan& scan = cut.scans.at(1);
  EXPECT_THAT(scan.x_lidar, ElementsAre(1, 1, 2, 2));
  EXPECT_THAT(scan.y_lidar, ElementsAre(0, 1, 0, 1));
  EXPECT_THAT(scan.intensity, ElementsAre(1, 1, 2, 2));
  EXPECT_THAT(scan.ring, ElementsAre(0, 1, 0, 1));
  EXPECT_THAT(scan.time_ns, ElementsAre(0, 1152, 45'920, 45'920 + 1152));
  EXPECT_EQ(scan.firings[1].first_return, 2U);
  EXPECT_EQ(scan.firings[1].return_count, 2U);
}

TEST(ScanContents, ReturnsBeyondTheCapacityAreCountedAndTheNextScanIsWhole) {
  Cutting cut({}, 60, 100);
  cut.push(packet_of({35940, 35955, 35970}, kFirstPacket, 32));
  cut.push(packet_of({5, 20}, kFirstPacket + 138us, 16));
  cut.finish();
  EXPECT_EQ(cut.scans[0].size(), 60U);
  EXPECT_EQ(cut.scans[0].overflow_returns, 36U);
  EXPECT_EQ(cut.scans[1].size(), 32U);
  EXPECT_EQ(cut.scans[1].overflow_returns, 0U);
}

TEST(ScanContents, FiringsBeyondTheCapacityAreCountedWithTheirReturns) {
  Cutting cut({}, 1000, 2);
  cut.push(packet_of({10, 25, 40}, kFirstPacket, 3));
  cut.finish();
  EXPECT_EQ(cut.scans[0].firings.size(), 2U);
  EXPECT_EQ(cut.scans[0].size(), 6U);
  EXPECT_EQ(cut.scans[0].overflow_returns, 3U);
}

TEST(ScanContents, ScanMayBeSwappedForAnother) {
  ScanCutter cutter({}, 1000, 100);
  Scan mine;
  reserve(mine, 1000, 100);
  mine.x_lidar.assign(7, 1.0F);  // the remains of an earlier use
  const float* const storage = mine.x_lidar.data();
  const auto swap = [&](Scan& scan) { std::swap(scan, mine); };
  const TimedBatch first = packet_of({35985, 0, 15}, kFirstPacket, 4);
  cutter.push(first.batch, first.first_firing, swap);
  EXPECT_EQ(mine.size(), 4U);
  cutter.finish(swap);
  EXPECT_EQ(mine.x_lidar.data(), storage);
  EXPECT_EQ(mine.size(), 8U);
  EXPECT_EQ(mine.index, 1U);
}

TEST(ScanContents, SmallerScanThatIsSwappedInOverflowsEarlierAndGrowsNot) {
  ScanCutter cutter({}, 1000, 100);
  Scan mine;
  reserve(mine, 3, 100);
  const auto swap = [&](Scan& scan) { std::swap(scan, mine); };
  const TimedBatch timed = packet_of({35985, 0, 15}, kFirstPacket, 4);
  cutter.push(timed.batch, timed.first_firing, swap);
  cutter.finish(swap);
  EXPECT_EQ(mine.size(), 3U);
  EXPECT_EQ(mine.overflow_returns, 5U);
}

}  // namespace
}  // namespace convexcut
