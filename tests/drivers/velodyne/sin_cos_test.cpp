// SPDX-License-Identifier: Apache-2.0
//
// Does not prove: the speed that the table is there for.
#include "drivers/velodyne/sin_cos.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace convexcut::velodyne {
namespace {

double error(Azimuth angle) {
  const SinCos ours = sin_cos(angle);
  const double radians = angle.radians().value;
  return std::max(std::abs(ours.sin - std::sin(radians)), std::abs(ours.cos - std::cos(radians)));
}

TEST(SinCos, MatchesTheLibraryAtEveryCentidegree) {
  double worst = 0.0;
  for (int centidegrees = 0; centidegrees < 36000; ++centidegrees) {
    worst = std::max(worst, error(Azimuth::from_centidegrees(centidegrees)));
  }
  EXPECT_LT(worst, 1e-12);
}

TEST(SinCos, MatchesTheLibraryBetweenCentidegrees) {
  double worst = 0.0;
  for (int microdegrees = 0; microdegrees < Azimuth::kFullTurn; microdegrees += 9'973) {
    worst = std::max(worst, error(Azimuth::from_microdegrees(microdegrees)));
  }
  EXPECT_LT(worst, 1e-12);
}

TEST(SinCos, MatchesTheLibraryFarthestFromTheTableAndAtTheEndOfTheTurn) {
  for (const int microdegrees :
       {499'999, 500'000, 500'001, 359'499'999, 359'500'000, 359'999'999}) {
    EXPECT_LT(error(Azimuth::from_microdegrees(microdegrees)), 1e-12) << microdegrees;
  }
}

TEST(SinCos, QuarterTurnsAreExact) {
  EXPECT_EQ(sin_cos(Azimuth::from_centidegrees(0)).sin, 0.0);
  EXPECT_EQ(sin_cos(Azimuth::from_centidegrees(9000)).cos, 0.0);
  EXPECT_EQ(sin_cos(Azimuth::from_centidegrees(9000)).sin, 1.0);
  EXPECT_EQ(sin_cos(Azimuth::from_centidegrees(18000)).cos, -1.0);
  EXPECT_EQ(sin_cos(Azimuth::from_centidegrees(27000)).sin, -1.0);
}

TEST(SinCos, ThirtySixThousandCentidegreesIsTheDirectionOfZero) {
  const SinCos full = sin_cos(Azimuth::from_centidegrees(36000));
  EXPECT_EQ(full.sin, 0.0);
  EXPECT_EQ(full.cos, 1.0);
}

}  // namespace
}  // namespace convexcut::velodyne
