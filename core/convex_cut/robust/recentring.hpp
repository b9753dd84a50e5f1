// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"

namespace convexcut::robust {

// The model's plane `k` as one revolution shows it: moved by some centimetres and tenths of a
// degree at most, as far as the revolution's voxels hold it (mean and points of them are used).
[[nodiscard]] Plane recentred(const Model& model, const PlaneGrids& grids, std::size_t k,
                              std::span<const Surfel> revolution) noexcept;

}  // namespace convexcut::robust
