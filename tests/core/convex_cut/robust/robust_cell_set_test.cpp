// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/cell_set.hpp"

namespace convexcut {
namespace {

TEST(RobustCellSet, TakesOutWhatIsWithinReachAndNothingElse) {
  constexpr std::int32_t kColumns = 11;
  constexpr std::int32_t kRows = 9;
  using Places = std::set<std::array<std::int32_t, 2>>;
  std::mt19937 random(9);
  robust::CellSet set(kColumns * kRows);
  for (int i = 0; i < 200; ++i) {
    Places expected;
    set.assign(kColumns, kRows, false);
    for (std::int32_t k = 0; k < kColumns * kRows; ++k) {
      if (random() % 2 == 0) continue;
      set.insert(k % kColumns, k / kColumns);
      expected.insert({k % kColumns, k / kColumns});
    }
    const auto column = static_cast<std::int32_t>(2 + random() % (kColumns - 4));
    const auto row = static_cast<std::int32_t>(2 + random() % (kRows - 4));
    Places taken;
    set.take_around(column, row, [&](std::int32_t c, std::int32_t r) { taken.insert({c, r}); });
    for (std::int32_t k = 0; k < kColumns * kRows; ++k) {
      const std::array<std::int32_t, 2> at{k % kColumns, k / kColumns};
      const bool within = std::abs(at[0] - column) <= 2 && std::abs(at[1] - row) <= 2;
      const bool was_in = expected.contains(at);
      ASSERT_EQ(taken.contains(at), was_in && within);
      ASSERT_EQ(set.contains(at[0], at[1]), was_in && !within);
    }
  }
}

}  // namespace
}  // namespace convexcut
