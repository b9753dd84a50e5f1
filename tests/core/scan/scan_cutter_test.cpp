// SPDX-License-Identifier: Apache-2.0
//
// Cutting by azimuth and by time, on synthetic firings and on a real recording. Does not prove what
// the driver makes of a datagram, nor (see scan_property_test.cpp) arbitrary losses.
#include "core/scan/scan_cutter.hpp"

#include <chrono>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/scan/courtyard.hpp"
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

CutOptions clock_mode() {
  CutOptions options;
  options.mode = CutOptions::Mode::clock;
  return options;
}

TEST(ScanCutter, CourtyardRevolutionsHoldTheirExactReturns) {
  CONVEXCUT_NEEDS_RECORDING(file, test::kCourtyard);
  Cutting cut;
  for (const TimedBatch& timed : test::read_courtyard(file)) cut.push(timed);
  cut.finish();
  ASSERT_THAT(cut.firings(), ElementsAre(918, 2401, 2401, 280));
  EXPECT_EQ(cut.scans[0].size(), 23'216U);
  EXPECT_EQ(cut.scans[1].size(), 57'734U);
  EXPECT_EQ(cut.scans[2].size(), 57'882U);
  EXPECT_EQ(cut.scans[3].size(), 7'873U);
  EXPECT_EQ(cut.scans[1].coverage(), 1.0);
  EXPECT_EQ(cut.scans[2].coverage(), 1.0);
  EXPECT_NEAR(cut.scans[0].coverage(), 918.0 / 2401.0, 1e-3);
  EXPECT_NEAR(cut.scans[3].coverage(), 280.0 / 2401.0, 1e-3);
  EXPECT_NEAR(cut.scans[1].rotor_hz, 9.04, 0.005);
  EXPECT_EQ(cut.scans[3].end, ScanEnd::end_of_input);
}

TEST(ScanCutter, CutIsAtTheFiringNotAtTheDatagram) {
  Cutting cut;
  cut.push(packet_of({35970, 35985, 0, 15}, kFirstPacket));
  cut.finish();
  EXPECT_THAT(cut.firings(), ElementsAre(2, 2));
  EXPECT_EQ(cut.scans[1].first_firing, kFirstPacket + 2 * 46'080ns);
  EXPECT_EQ(cut.scans[0].last_firing, kFirstPacket + 46'080ns);
  EXPECT_EQ(cut.scans[0].end, ScanEnd::cut);
}

TEST(ScanCutter, AzimuthOf36000IsTheFirstOfTheNextScan) {
  Cutting cut;
  cut.push(packet_of({35970, 35985, 36000, 15, 30}, kFirstPacket));
  cut.finish();
  EXPECT_THAT(cut.firings(), ElementsAre(2, 3));
}

TEST(ScanCutter, CutAzimuthIsConfigurable) {
  CutOptions options;
  options.cut_azimuth = Azimuth::from_centidegrees(9000);
  Cutting cut(options);
  cut.push(packet_of({8970, 8985, 9000, 9015, 9030}, kFirstPacket));
  cut.push(packet_of({35985, 0, 15}, kFirstPacket + 75ms));
  cut.finish();
  EXPECT_THAT(cut.firings(), ElementsAre(2, 6));
}

TEST(ScanCutter, EncoderThatJittersAcrossTheCutCutsOnce) {
  Cutting cut;
  cut.push(packet_of({35980, 35995, 5, 35998, 10, 35999, 25, 40}, kFirstPacket));
  cut.finish();
  EXPECT_THAT(cut.firings(), ElementsAre(2, 6));
}

TEST(ScanCutter, SingleImpossibleAzimuthDoesNotCut) {
  for (const std::int64_t wrong : {0, 9000, 18'000, 27'000, 35'990}) {
    Cutting cut;
    cut.push(packet_of({100, 115, 130, wrong, 160, 175, 190, 205}, kFirstPacket));
    cut.finish();
    EXPECT_THAT(cut.firings(), ElementsAre(8)) << wrong;
  }
}

TEST(ScanCutter, ImpossibleAzimuthIsCounted) {
  Cutting cut;
  cut.push(packet_of({100, 115, 130, 27'000, 160, 175}, kFirstPacket));
  EXPECT_EQ(cut.cutter.counters().azimuth_glitches.value(), 1U);
}

TEST(ScanCutter, AzimuthThatStaysElsewhereIsBelieved) {
  SyntheticLidar lidar;
  lidar.encoder_error = [](std::int64_t firing) { return firing >= 1000 ? 9000 : 0; };
  Cutting cut;
  cut.push(lidar, 0, 350);
  cut.finish();
  // 0.166° a firing: 270° are left of the first revolution.
  ASSERT_EQ(cut.scans.size(), 3U);
  EXPECT_NEAR(static_cast<double>(cut.scans[0].firings.size()), 2170.0 * 0.75, 2.0);
  EXPECT_EQ(cut.scans[1].coverage(), 1.0);
}

TEST(ScanCutter, WholeRevolutionCoversAllAtEverySpeed) {
  for (const double hz : {5.0, 7.3, 9.04, 10.0, 13.7, 20.0}) {
    SyntheticLidar lidar;
    lidar.rate_hz = hz;
    lidar.returns_per_firing = 1;
    Cutting cut;
    cut.push(lidar, 0, lidar.packets_in(1s));
    ASSERT_GE(cut.scans.size(), 4U);
    for (const Scan& scan : cut.scans) {
      EXPECT_GE(scan.coverage(), 0.999) << hz;
      EXPECT_NEAR(scan.rotor_hz, hz, 0.01);
      EXPECT_NEAR(scan.expected_firings, 1e9 / (hz * test::kFiringPeriodNs), 2.0);
    }
  }
}

TEST(ScanCutter, PartOfARevolutionCoversItsShare) {
  SyntheticLidar lidar;
  lidar.start_degrees = 270.0;
  Cutting cut;
  cut.push(lidar, 0, 100);
  ASSERT_EQ(cut.scans.size(), 1U);
  EXPECT_NEAR(cut.scans[0].coverage(), 0.25, 0.001);
}

TEST(ScanCutter, FewFiringsBeforeTheFirstCutAreAScanOfTheirOwn) {
  SyntheticLidar lidar;
  lidar.start_degrees = 359.9;
  Cutting cut;
  cut.push(lidar, 0, 300);
  ASSERT_EQ(cut.scans.size(), 2U);
  EXPECT_EQ(cut.scans[0].firings.size(), 1U);
  EXPECT_LT(cut.scans[0].coverage(), 0.001);
  EXPECT_EQ(cut.scans[1].coverage(), 1.0);
}

struct Loss {
  double hz;
  Duration begin, length;
};
class ScanCutterLoss : public testing::TestWithParam<Loss> {};

TEST_P(ScanCutterLoss, CutsWhereTheRotorIsAndNeverTwice) {
  const Loss loss = GetParam();
  SyntheticLidar lidar;
  lidar.rate_hz = loss.hz;
  lidar.start_degrees = 0.005;
  lidar.returns_per_firing = 1;
  Cutting cut;
  cut.push(lidar, 0, lidar.packets_in(loss.begin));
  cut.push(lidar, lidar.packets_in(loss.begin + loss.length), lidar.packets_in(2s));
  cut.finish();
  std::int64_t last_turn = -1;
  for (const Scan& scan : cut.scans) {
    const std::vector<std::int64_t> numbers = test::firing_numbers(scan);
    const std::int64_t turn = lidar.centidegrees(numbers.front()) / 36'000;
    EXPECT_EQ(lidar.centidegrees(numbers.back()) / 36'000, turn);
    EXPECT_GT(turn, last_turn);
    last_turn = turn;
  }
}

INSTANTIATE_TEST_SUITE_P(WithinAScan, ScanCutterLoss,
                         testing::Values(Loss{10, 320ms, 30ms}, Loss{5, 450ms, 100ms},
                                         Loss{20, 310ms, 20ms}));
INSTANTIATE_TEST_SUITE_P(AcrossTheCut, ScanCutterLoss,
                         testing::Values(Loss{10, 370ms, 60ms}, Loss{5, 350ms, 100ms},
                                         Loss{20, 320ms, 45ms}));
INSTANTIATE_TEST_SUITE_P(OfMoreThanARevolution, ScanCutterLoss,
                         testing::Values(Loss{10, 330ms, 100ms}, Loss{10, 330ms, 120ms},
                                         Loss{10, 370ms, 290ms}, Loss{5, 350ms, 230ms},
                                         Loss{20, 320ms, 280ms}, Loss{10, 330ms, 1s}));
INSTANTIATE_TEST_SUITE_P(JustAfterTheStart, ScanCutterLoss,
                         testing::Values(Loss{5, 2ms, 40ms}, Loss{20, 2ms, 40ms}));

TEST(ScanCutter, LossIsMissingInTheCoverage) {
  SyntheticLidar lidar;
  Cutting cut;
  cut.push(lidar, 0, lidar.packets_in(130ms));
  cut.push(lidar, lidar.packets_in(150ms), lidar.packets_in(250ms));
  ASSERT_EQ(cut.scans.size(), 2U);
  EXPECT_NEAR(cut.scans[1].coverage(), 0.8, 0.006);  // whole datagrams are lost
}

TEST(ScanCutter, StandingRotorGivesTimeoutScans) {
  SyntheticLidar lidar;
  lidar.rate_hz = 0.0;
  lidar.start_degrees = 123.0;
  Cutting cut;
  cut.push(lidar, 0, lidar.packets_in(1s));
  ASSERT_EQ(cut.scans.size(), 3U);
  for (const Scan& scan : cut.scans) {
    EXPECT_EQ(scan.end, ScanEnd::timeout);
    EXPECT_LT(scan.last_firing - scan.first_firing, 300ms);
    EXPECT_GT(scan.last_firing - scan.first_firing, 299ms);
    EXPECT_EQ(scan.coverage(), 0.0);
  }
}

TEST(ScanCutter, RotorStandingOnTheCutDoesNotCut) {
  SyntheticLidar lidar;
  lidar.rate_hz = 0.0;
  lidar.encoder_error = [](std::int64_t firing) { return firing % 3 - 1; };
  Cutting cut;
  cut.push(lidar, 0, lidar.packets_in(280ms));
  cut.finish();
  EXPECT_LE(cut.scans.size(), 2U);  // the first passage may be one
}

TEST(ScanCutter, RotorThatStartsAgainIsCutAgain) {
  SyntheticLidar standing;
  standing.rate_hz = 0.0;
  Cutting cut;
  cut.push(standing, 0, standing.packets_in(1s));
  SyntheticLidar turning;
  turning.start = standing.start + 1s;
  const std::size_t before = cut.scans.size();
  cut.push(turning, 0, turning.packets_in(550ms));
  ASSERT_EQ(cut.scans.size(), before + 5);
  for (std::size_t i = before + 1; i < cut.scans.size(); ++i) {
    EXPECT_EQ(cut.scans[i].end, ScanEnd::cut);
    EXPECT_EQ(cut.scans[i].coverage(), 1.0);
  }
}

TEST(ScanCutter, ClockWindowsAreExactAndAligned) {
  SyntheticLidar lidar;
  lidar.rate_hz = 9.3;
  lidar.start += 42ms;
  lidar.returns_per_firing = 1;
  Cutting cut(clock_mode());
  cut.push(lidar, 0, lidar.packets_in(1s));
  cut.finish();
  ASSERT_EQ(cut.scans.size(), 11U);
  for (std::size_t i = 0; i < cut.scans.size(); ++i) {
    const Duration begin = i * 100ms;
    EXPECT_GE(cut.scans[i].first_firing, kFirstPacket + begin);
    EXPECT_LT(cut.scans[i].last_firing, kFirstPacket + begin + 100ms);
    EXPECT_EQ(cut.scans[i].expected_firings, 2170U);
  }
  for (std::size_t i = 1; i < 10; ++i) EXPECT_GE(cut.scans[i].coverage(), 0.999);
  EXPECT_NEAR(cut.scans[0].coverage(), 0.58, 0.001);
}

TEST(ScanCutter, FiringOnTheEdgeOfAClockWindowIsInTheNext) {
  Cutting cut(clock_mode());
  cut.push(packet_of({0, 15, 30}, kFirstPacket + 100ms - 46'080ns));
  cut.finish();
  EXPECT_THAT(cut.firings(), ElementsAre(1, 2));
}

TEST(ScanCutter, LostClockWindowsAreNotMadeUp) {
  SyntheticLidar lidar;
  Cutting cut(clock_mode());
  cut.push(lidar, 0, lidar.packets_in(150ms));
  cut.push(lidar, lidar.packets_in(450ms), lidar.packets_in(600ms));
  cut.finish();
  ASSERT_EQ(cut.scans.size(), 4U);
  EXPECT_NEAR(cut.scans[1].coverage(), 0.5, 0.006);
  EXPECT_NEAR(cut.scans[2].coverage(), 0.5, 0.006);
}

TEST(ScanCutter, RepeatedOrEarlierBatchIsDroppedAndCounted) {
  SyntheticLidar lidar;
  Cutting cut;
  cut.push(lidar.packet(5));
  cut.push(lidar.packet(5));
  cut.push(lidar.packet(3));
  cut.push(lidar.packet(6));
  cut.finish();
  EXPECT_THAT(cut.firings(), ElementsAre(24));
  EXPECT_EQ(cut.cutter.counters().stale_batches.value(), 2U);
}

TEST(ScanCutter, SourceThatRestartsEndsTheScan) {
  SyntheticLidar lidar;
  Cutting cut;
  cut.push(lidar, 0, 10);
  lidar.start -= 10s;
  cut.push(lidar, 0, 10);
  ASSERT_THAT(cut.firings(), ElementsAre(120));
  EXPECT_EQ(cut.scans[0].end, ScanEnd::end_of_input);
  cut.finish();
  EXPECT_THAT(cut.firings(), ElementsAre(120, 120));
}

TEST(ScanCutter, BatchesThatOverlapByMicrosecondsKeepTheOrderOfTime) {
  Cutting cut;
  cut.push(packet_of({100, 115, 130}, kFirstPacket));
  cut.push(packet_of({145, 160, 175}, kFirstPacket + 80us));
  cut.finish();
  ASSERT_THAT(cut.firings(), ElementsAre(6));
  for (std::size_t i = 1; i < 6; ++i) {
    EXPECT_GE(cut.scans[0].firings[i].time, cut.scans[0].firings[i - 1].time);
  }
}

TEST(ScanCutter, IndexCountsOnThroughFinish) {
  SyntheticLidar lidar;
  Cutting cut;
  cut.push(lidar, 0, 10);
  cut.finish();
  cut.push(lidar, 20, 30);
  cut.finish();
  ASSERT_EQ(cut.scans.size(), 2U);
  EXPECT_EQ(cut.scans[1].index, 1U);
}

TEST(ScanCutter, FinishOfNothingGivesNothing) {
  Cutting cut;
  cut.finish();
  EXPECT_TRUE(cut.scans.empty());
}

TEST(ScanCutter, OptionsOutOfRangeAreRefused) {
  CutOptions options;
  options.window = 5s;
  EXPECT_THROW(ScanCutter(options, 1, 1), std::invalid_argument);
  options = {};
  options.timeout = 0s;
  EXPECT_THROW(ScanCutter(options, 1, 1), std::invalid_argument);
  options = {};
  options.min_range_m = 2000.0;
  EXPECT_THROW(ScanCutter(options, 1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace convexcut
