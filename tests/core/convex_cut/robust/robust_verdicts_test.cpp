// SPDX-License-Identifier: Apache-2.0
//
// How earlier decisions weigh. What that is worth is measured by bench/accuracy.
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/verdicts.hpp"

namespace convexcut {
namespace {

// The last of the answers to these decisions: s for structure, o for an object.
[[nodiscard]] robust::Verdict verdict_after(std::string_view decisions) {
  robust::Verdicts verdicts;
  robust::Verdict verdict = robust::Verdict::as_now;
  for (const char decision : decisions) verdict = verdicts.add(decision == 's');
  return verdict;
}

TEST(RobustVerdicts, TheFirstRevolutionDecidesAlone) {
  EXPECT_EQ(verdict_after("s"), robust::Verdict::as_now);
  EXPECT_EQ(verdict_after("o"), robust::Verdict::as_now);
}

TEST(RobustVerdicts, OneRevolutionChangesNothingAfterMany) {
  EXPECT_EQ(verdict_after("sssso"), robust::Verdict::structure);
  EXPECT_EQ(verdict_after("oooos"), robust::Verdict::object);
}

TEST(RobustVerdicts, TwoInARowMakeStructureAndHalfOfAllAnObject) {
  EXPECT_EQ(verdict_after("ooooooooss"), robust::Verdict::as_now);
  EXPECT_EQ(verdict_after("ssssooo"), robust::Verdict::structure);
  EXPECT_EQ(verdict_after("ssssoooo"), robust::Verdict::as_now);
}

TEST(RobustVerdicts, WhatIsLongPastFades) {
  const std::string past(200, 's');
  EXPECT_EQ(verdict_after(past + std::string(10, 'o')), robust::Verdict::structure);
  EXPECT_EQ(verdict_after(past + std::string(12, 'o')), robust::Verdict::as_now);
}

}  // namespace
}  // namespace convexcut
