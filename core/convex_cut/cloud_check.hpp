// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/cloud.hpp"
#include "core/convex_cut/cloud_kernels.hpp"
#include "core/convex_cut/parameters.hpp"

namespace convexcut {

struct CloudCheck {
  CutStatus status = CutStatus::ok;
  float extent_m = 0.0F;  // the greatest magnitude of any coordinate, when the status is ok
};

[[nodiscard]] inline bool sizes_match(const CloudView& cloud, std::size_t label_count) noexcept {
  const std::size_t n = cloud.size();
  return cloud.y.size() == n && cloud.z.size() == n && label_count == n;
}

// Whether a cloud and its labels can be worked on at all.
[[nodiscard]] inline CloudCheck check_cloud(const CloudView& cloud,
                                            std::size_t label_count) noexcept {
  if (!sizes_match(cloud, label_count)) return {CutStatus::size_mismatch};
  const std::uint32_t bits =
      std::max({greatest_magnitude_bits(cloud.x), greatest_magnitude_bits(cloud.y),
                greatest_magnitude_bits(cloud.z)});
  if (bits > std::bit_cast<std::uint32_t>(kMaxCoordinateM)) {
    return {CutStatus::coordinate_out_of_range};
  }
  return {CutStatus::ok, std::bit_cast<float>(bits)};
}

}  // namespace convexcut
