// SPDX-License-Identifier: Apache-2.0
//
// Which instruction set the kernels run with. Highway chooses the best that the processor has; a
// program may force another one before it starts its threads. No path changes a result.
#pragma once

#include <string_view>
#include <vector>

namespace convexcut {

// Of this processor and this build, the best first: avx512, avx2, sse4, neon, baseline.
[[nodiscard]] std::vector<std::string_view> simd_paths();

// The one in use.
[[nodiscard]] std::string_view simd_path();

// Forces one of simd_paths(), or with "auto" the best again. False, and nothing is changed, for any
// other name. Not while kernels run.
[[nodiscard]] bool use_simd_path(std::string_view name);

}  // namespace convexcut
