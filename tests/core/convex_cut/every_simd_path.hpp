// SPDX-License-Identifier: Apache-2.0
//
// Runs tests once for each instruction set that the kernels are compiled for and this processor
// has.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "core/simd/simd_path.hpp"

namespace convexcut::test {

class EverySimdPath : public testing::TestWithParam<std::string_view> {
 protected:
  void SetUp() override { ASSERT_TRUE(use_simd_path(GetParam())); }
  void TearDown() override { ASSERT_TRUE(use_simd_path("auto")); }
};

}  // namespace convexcut::test

#define CONVEXCUT_ON_EVERY_SIMD_PATH(Suite)                                       \
  INSTANTIATE_TEST_SUITE_P(EverySimdPath, Suite, testing::ValuesIn(simd_paths()), \
                           [](const auto& tested) { return std::string(tested.param); })
