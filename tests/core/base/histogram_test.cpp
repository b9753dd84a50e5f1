// SPDX-License-Identifier: Apache-2.0
//
// Does not prove that readers on other threads see a consistent moment: they need not.
#include "core/histogram.hpp"

#include <atomic>
#include <cmath>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace convexcut {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

// The nearest rank of a sorted list: what percentile() is held against.
Duration exact_percentile(const std::vector<Duration>& sorted, double percent) {
  const auto rank = static_cast<std::size_t>(
      std::ceil(percent * static_cast<double>(sorted.size()) / 100.0 - 1e-9));
  return sorted[std::max<std::size_t>(rank, 1) - 1];
}

// As documented: 1/64 of the value, or 16 ns below kFinest.
Duration allowed_error(Duration value) { return std::max(Duration{16}, value / 64 + Duration{1}); }

TEST(LatencyHistogram, IsZeroBeforeTheFirstRecord) {
  const LatencyHistogram histogram;
  EXPECT_EQ(histogram.count(), 0U);
  EXPECT_EQ(histogram.percentile(50.0), Duration::zero());
  EXPECT_EQ(histogram.percentile(100.0), Duration::zero());
  EXPECT_EQ(histogram.max(), Duration::zero());
  EXPECT_EQ(histogram.mean(), Duration::zero());
}

TEST(LatencyHistogram, MaxTotalAndMeanAreExact) {
  LatencyHistogram histogram;
  for (const std::int64_t ns : {1'234'567, 7, 9'999'999}) histogram.record(Duration{ns});
  EXPECT_EQ(histogram.count(), 3U);
  EXPECT_EQ(histogram.max(), Duration{9'999'999});
  EXPECT_EQ(histogram.percentile(100.0), Duration{9'999'999});
  EXPECT_EQ(histogram.total(), Duration{11'234'573});
  EXPECT_EQ(histogram.mean(), Duration{11'234'573 / 3});
}

TEST(LatencyHistogram, EveryBucketsEdgesAreReadBackWithinTheError) {
  // Around every power of two and every 1/32 of it: where an off-by-one would show.
  for (std::int64_t octave = 5; octave < 36; ++octave) {
    for (std::int64_t part = 0; part < 32; ++part) {
      const std::int64_t edge =
          (std::int64_t{1} << octave) + part * ((std::int64_t{1} << octave) / 32);
      for (const std::int64_t ns : {edge - 1, edge, edge + 1}) {
        LatencyHistogram histogram;
        histogram.record(Duration{ns});
        histogram.record(LatencyHistogram::kLongest);  // so that the first is not the maximum
        const Duration found = histogram.percentile(50.0);
        EXPECT_LE(std::abs((found - Duration{ns}).count()), allowed_error(Duration{ns}).count())
            << ns;
      }
    }
  }
}

TEST(LatencyHistogram, BeyondItsRangeItCountsTheNearestItHas) {
  LatencyHistogram histogram;
  histogram.record(milliseconds{-5});
  EXPECT_EQ(histogram.max(), Duration::zero());
  EXPECT_EQ(histogram.percentile(50.0), Duration::zero());
  histogram.record(seconds{3600});
  EXPECT_EQ(histogram.count(), 2U);
  EXPECT_EQ(histogram.max(), LatencyHistogram::kLongest);
  EXPECT_GE(LatencyHistogram::kLongest, seconds{60});
}

TEST(LatencyHistogram, PercentilesBelowZeroAndAboveAHundredAreTheEnds) {
  LatencyHistogram histogram;
  for (int ms = 1; ms <= 100; ++ms) histogram.record(milliseconds{ms});
  EXPECT_EQ(histogram.percentile(-1.0), histogram.percentile(0.0));
  EXPECT_EQ(histogram.percentile(101.0), milliseconds{100});
  EXPECT_LE(std::abs((histogram.percentile(0.0) - milliseconds{1}).count()), 1'000'000 / 64);
}

TEST(LatencyHistogram, NinetyNinePercentOfAHundredIsTheNinetyNinth) {
  LatencyHistogram histogram;
  for (int i = 0; i < 99; ++i) histogram.record(milliseconds{1});
  histogram.record(milliseconds{500});
  EXPECT_LT(histogram.percentile(99.0), milliseconds{2});
  EXPECT_EQ(histogram.percentile(99.9), milliseconds{500});
}

// Latencies of very different shapes, against an exact sort.
TEST(LatencyHistogram, PercentilesOfManyShapesAreThoseOfASortWithinTheError) {
  std::mt19937_64 random(20261122);
  for (int round = 0; round < 200; ++round) {
    std::uniform_real_distribution<double> exponent(2.0, 10.8);  // 100 ns … 63 s
    const double low = exponent(random);
    const double high = exponent(random);
    std::uniform_real_distribution<double> shape(std::min(low, high), std::max(low, high) + 1e-6);
    std::vector<Duration> all;
    LatencyHistogram histogram;
    const std::size_t count = 1 + random() % 3000;
    for (std::size_t i = 0; i < count; ++i) {
      all.emplace_back(static_cast<Duration::rep>(std::pow(10.0, shape(random))));
      histogram.record(all.back());
    }
    std::sort(all.begin(), all.end());
    for (const double percent : {0.1, 1.0, 10.0, 50.0, 90.0, 99.0, 99.9, 99.99, 100.0}) {
      const Duration exact = exact_percentile(all, percent);
      EXPECT_LE(std::abs((histogram.percentile(percent) - exact).count()),
                allowed_error(exact).count())
          << percent << " % of " << count;
    }
    EXPECT_EQ(histogram.max(), all.back());
  }
}

TEST(LatencyHistogram, PercentilesDoNotDecreaseWithThePercentage) {
  std::mt19937_64 random(7);
  LatencyHistogram histogram;
  for (int i = 0; i < 1000; ++i) {
    histogram.record(Duration{static_cast<Duration::rep>(random() % 100'000'000)});
  }
  Duration before{};
  for (int tenth = 0; tenth <= 1000; ++tenth) {
    const Duration now = histogram.percentile(tenth / 10.0);
    EXPECT_GE(now, before);
    before = now;
  }
}

TEST(LatencyHistogram, IsReadWhileItIsWritten) {
  const auto histogram = std::make_unique<LatencyHistogram>();
  constexpr std::uint64_t kRecords = 200'000;
  std::thread writer([&] {
    for (std::uint64_t i = 0; i < kRecords; ++i) histogram->record(microseconds{1 + i % 1000});
  });
  std::uint64_t count = 0;
  while (count < kRecords) {
    const std::uint64_t now = histogram->count();
    EXPECT_GE(now, count);
    const Duration percentile = histogram->percentile(99.0);  // the writer goes on before max()
    EXPECT_LE(percentile, histogram->max());
    EXPECT_LE(histogram->max(), microseconds{1000});
    count = now;
  }
  writer.join();
  EXPECT_EQ(histogram->count(), kRecords);
}

}  // namespace
}  // namespace convexcut
