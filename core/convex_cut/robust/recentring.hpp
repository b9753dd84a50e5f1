// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"
#include "core/convex_cut/robust/voxel_map.hpp"

namespace convexcut::robust {

// The model's plane `k` as one revolution shows it: moved by some centimetres and tenths of a
// degree at most, as far as the revolution's voxels hold it.
[[nodiscard]] Plane recentred(const Model& model, const PlaneGrids& grids, std::size_t k,
                              const VoxelMap& revolution) noexcept;

}  // namespace convexcut::robust
