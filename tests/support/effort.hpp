// SPDX-License-Identifier: Apache-2.0
//
// How much of the long random tests is run: CONVEXCUT_TEST_PERCENT (100), less where a test runs
// under an emulator. Tests that cannot be cut short are left out below 100.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include <gtest/gtest.h>

namespace convexcut::test {

[[nodiscard]] inline std::uint64_t test_percent() {
  const char* const text = std::getenv("CONVEXCUT_TEST_PERCENT");
  return text == nullptr ? 100 : std::strtoull(text, nullptr, 10);
}

// That part of `full` repetitions, at least one.
[[nodiscard]] inline std::uint64_t repetitions(std::uint64_t full) {
  return std::max<std::uint64_t>(full * test_percent() / 100, 1);
}

}  // namespace convexcut::test

#define CONVEXCUT_LONG_TEST()                        \
  if (convexcut::test::test_percent() < 100)         \
  GTEST_SKIP() << "CONVEXCUT_TEST_PERCENT asks for " \
                  "less"
