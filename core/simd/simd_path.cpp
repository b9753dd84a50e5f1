// SPDX-License-Identifier: Apache-2.0
#include "core/simd/simd_path.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include <hwy/highway.h>

namespace convexcut {
namespace {

struct Path {
  std::string_view name;
  std::int64_t target;
};

// The best first. "baseline" is what every processor of the architecture has.
constexpr std::array kPaths{
    Path{"avx512", HWY_AVX3},
    Path{"avx2", HWY_AVX2},
    Path{"sse4", HWY_SSE4},
    Path{"neon", HWY_NEON},
    Path{"baseline", HWY_SCALAR | HWY_EMU128},
};

[[nodiscard]] std::int64_t available() { return hwy::SupportedTargets() & HWY_TARGETS; }

void limit_to(std::int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  // The tables of functions are indexed by what was chosen; choose again.
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace

std::vector<std::string_view> simd_paths() {
  const std::string_view in_use = simd_path();
  limit_to(0);
  std::vector<std::string_view> names;
  for (const Path& path : kPaths) {
    if ((path.target & available()) != 0) names.push_back(path.name);
  }
  static_cast<void>(use_simd_path(in_use));
  return names;
}

std::string_view simd_path() {
  // The lowest bit is the best target.
  const std::int64_t targets = available();
  for (const Path& path : kPaths) {
    if ((path.target & targets) != 0) return path.name;
  }
  return kPaths.back().name;
}

bool use_simd_path(std::string_view name) {
  if (name == "auto") {
    limit_to(0);
    return true;
  }
  const auto* const path = std::ranges::find(kPaths, name, &Path::name);
  if (path == kPaths.end()) return false;
  const std::string_view in_use = simd_path();
  limit_to(0);
  if ((path->target & available()) == 0) {
    static_cast<void>(use_simd_path(in_use));
    return false;
  }
  limit_to(path->target & available());
  return true;
}

}  // namespace convexcut
