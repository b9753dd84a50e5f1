// SPDX-License-Identifier: Apache-2.0
//
// Does not prove that the sign survives overflow or underflow: the range is a precondition.
#include "core/convex_cut/orientation.hpp"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "tests/core/convex_cut/clouds.hpp"

namespace convexcut {
namespace {

__extension__ using Int128 = __int128;

// The sign of the determinant of points with integer coordinates below 2⁶⁰, in integers.
[[nodiscard]] int integer_orientation(const SlicePoint& a, const SlicePoint& b,
                                      const SlicePoint& c) {
  const auto whole = [](double value) { return Int128{static_cast<std::int64_t>(value)}; };
  const Int128 left = (whole(a.u) - whole(c.u)) * (whole(b.z) - whole(c.z));
  const Int128 right = (whole(a.z) - whole(c.z)) * (whole(b.u) - whole(c.u));
  return static_cast<int>(left > right) - static_cast<int>(left < right);
}

TEST(Orientation, CounterClockwiseIsPositive) {
  EXPECT_EQ(orientation({0, 0}, {1, 0}, {0, 1}), 1);
  EXPECT_EQ(orientation({0, 0}, {0, 1}, {1, 0}), -1);
  EXPECT_EQ(orientation({0, 0}, {1, 2}, {3, 6}), 0);
}

TEST(Orientation, IsExactWhereTheRoundedDeterminantIsNot) {
  // Points a few last bits about the line through (12, 12) and (24, 24), scaled by 2⁵³ to integers:
  // the standard example of a rounded cross product that says anything.
  const SlicePoint b{12 * 0x1p53, 12 * 0x1p53};
  const SlicePoint c{24 * 0x1p53, 24 * 0x1p53};
  int rounding_is_wrong = 0;
  for (int i = 0; i < 64; ++i) {
    for (int k = 0; k < 64; ++k) {
      const SlicePoint a{0x1p52 + i, 0x1p52 + k};
      const int exact = integer_orientation(a, b, c);
      EXPECT_EQ(orientation(a, b, c), exact) << i << ", " << k;
      const double rounded = (b.u - a.u) * (c.z - a.z) - (b.z - a.z) * (c.u - a.u);
      const int rounded_sign = static_cast<int>(rounded > 0) - static_cast<int>(rounded < 0);
      rounding_is_wrong += static_cast<int>(rounded_sign != exact);
    }
  }
  EXPECT_GT(rounding_is_wrong, 0) << "the example shows nothing";
}

TEST(Orientation, AgreesWithIntegersOnNearlyCollinearPoints) {
  test::Random random(1);
  for (int i = 0; i < 20'000; ++i) {
    const SlicePoint a{std::floor(random.uniform(-0x1p50, 0x1p50)),
                       std::floor(random.uniform(-0x1p50, 0x1p50))};
    const SlicePoint b{std::floor(random.uniform(-0x1p50, 0x1p50)),
                       std::floor(random.uniform(-0x1p50, 0x1p50))};
    const double t = random.uniform(-1, 2);
    const SlicePoint c{std::floor(a.u + t * (b.u - a.u)) + std::floor(random.uniform(-2, 3)),
                       std::floor(a.z + t * (b.z - a.z)) + std::floor(random.uniform(-2, 3))};
    ASSERT_EQ(orientation(a, b, c), integer_orientation(a, b, c)) << i;
  }
}

TEST(Orientation, DoesNotDependOnWhichPointComesFirst) {
  test::Random random(2);
  for (int i = 0; i < 5'000; ++i) {
    const SlicePoint a{random.uniform(-5, 5), random.uniform(-5, 5)};
    const SlicePoint b{random.uniform(-5, 5), random.uniform(-5, 5)};
    const double t = random.uniform(-1, 2);
    const SlicePoint c{a.u + t * (b.u - a.u), a.z + t * (b.z - a.z)};
    const int turn = orientation(a, b, c);
    ASSERT_EQ(orientation(b, c, a), turn) << i;
    ASSERT_EQ(orientation(c, b, a), -turn) << i;
  }
}

}  // namespace
}  // namespace convexcut
