// SPDX-License-Identifier: Apache-2.0
//
// Does not prove that a path is quicker than another: the benchmark shows that.
#include "core/simd/simd_path.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace convexcut {
namespace {

TEST(SimdPath, IsTheBestUnlessForced) {
  ASSERT_TRUE(use_simd_path("auto"));
  EXPECT_EQ(simd_path(), simd_paths().front());
}

TEST(SimdPath, EveryOneOfThisProcessorCanBeForced) {
  for (const std::string_view name : simd_paths()) {
    EXPECT_TRUE(use_simd_path(name));
    EXPECT_EQ(simd_path(), name);
  }
  EXPECT_TRUE(use_simd_path("auto"));
}

TEST(SimdPath, ListingThemLeavesTheForcedOneInUse) {
  const std::string_view last = simd_paths().back();
  ASSERT_TRUE(use_simd_path(last));
  EXPECT_GE(simd_paths().size(), 1U);
  EXPECT_EQ(simd_path(), last);
  ASSERT_TRUE(use_simd_path("auto"));
}

TEST(SimdPath, UnknownOnesAreRefused) {
  EXPECT_FALSE(use_simd_path("altivec"));
  EXPECT_EQ(simd_path(), simd_paths().front());
}

}  // namespace
}  // namespace convexcut
