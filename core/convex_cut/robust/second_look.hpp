// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"

namespace convexcut::robust {

// Decides doubtful segments of model.segments by how they were seen, once walls and furniture are
// told apart and where a floor is known. As walls are accepted after all, as far as no ray passes
// them:
// - what begins well above the lidar, is taller than a person, or rises flat above all furniture.
// Rejected, where they are no higher than things that stand about:
// - slivers; what rays have passed where it was seen, as it has gone on;
// - small planes that were seen along themselves, or by few points for their size;
// - a few cells that were seen askew.
// RT: no allocation.
void take_second_look(Model& model, const PlaneGrids& grids, const Sighting& sighting) noexcept;

// Rejects accepted segments in small planes most of whose cells have something close before them,
// as mark_backs() has told: what stands behind furniture is furniture's. RT: no allocation.
void reject_what_is_behind(Model& model, PlaneGrids& grids) noexcept;

}  // namespace convexcut::robust
