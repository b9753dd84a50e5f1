// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace convexcut {

// The defaults are for a lidar with 2 cm of range noise in rooms and halls.
struct PlaneOptions {
  // 1 σ of a return across the surface that it came from.
  double noise_m = 0.02;
  // Cells are cubes of largest_cell_m, halved as long as what is left in them is not flat, at most
  // `levels` times: 3.2 m … 0.2 m.
  double largest_cell_m = 3.2;
  std::uint32_t levels = 4;
  // A cell is flat when a plane holds this many of its points and this share of them.
  std::uint32_t least_cell_points = 10;
  double least_cell_share = 0.6;
  // Pieces of a plane that are further apart than this are different patches.
  double largest_gap_m = 0.6;
  // What is smaller is no patch.
  std::uint32_t least_patch_points = 40;
  double least_patch_width_m = 0.1;
};

// False for NaN as well.
[[nodiscard]] constexpr bool is_valid(const PlaneOptions& o) noexcept {
  return o.noise_m >= 1e-6 && o.noise_m <= 1.0 &&                 //
         o.largest_cell_m >= 1e-3 && o.largest_cell_m <= 1e3 &&   //
         o.levels <= 8 && o.least_cell_points >= 4 &&             //
         o.least_cell_share >= 0.5 && o.least_cell_share <= 1 &&  //
         o.largest_gap_m >= 0.0 && o.largest_gap_m <= 1e3 &&      //
         o.least_patch_width_m >= 0.0 && o.least_patch_width_m <= 1e3;
}

}  // namespace convexcut
