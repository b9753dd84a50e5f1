// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/voxel_map.hpp"

namespace convexcut::robust {

// How far the points of each surfel that is on a plane, and of each plane, are off the plane; which
// planes were mostly seen along themselves; and what the sensor's noise is. `voxels` are those that
// the surfels were made of, in their order. RT.
void measure_spread(Model& model, std::span<const Voxel> voxels) noexcept;

}  // namespace convexcut::robust
