// SPDX-License-Identifier: Apache-2.0
#include "core/angle.hpp"

#include <gtest/gtest.h>

namespace convexcut {
namespace {

TEST(Azimuth, ThirtySixThousandCentidegreesIsZero) {
  EXPECT_EQ(Azimuth::from_centidegrees(36000), Azimuth{});
  EXPECT_EQ(Azimuth::from_centidegrees(35999).microdegrees(), 359'990'000);
}

TEST(Azimuth, AnyValueIsReducedToOneTurn) {
  EXPECT_EQ(Azimuth::from_microdegrees(-1).microdegrees(), 359'999'999);
  EXPECT_EQ(Azimuth::from_microdegrees(720'000'005).microdegrees(), 5);
  EXPECT_EQ(Azimuth::from_degrees(Degrees{-90.0}).microdegrees(), 270'000'000);
}

TEST(Azimuth, ClockwiseDistanceCrossesZero) {
  const Azimuth before = Azimuth::from_centidegrees(35990);
  const Azimuth after = Azimuth::from_centidegrees(10);
  EXPECT_EQ(after.clockwise_from(before), 200'000);
  EXPECT_EQ(before.clockwise_from(after), Azimuth::kFullTurn - 200'000);
}

TEST(Azimuth, OneFortiethOfACentidegreeIsExact) { EXPECT_EQ(Azimuth::kPerCentidegree % 40, 0); }

}  // namespace
}  // namespace convexcut
