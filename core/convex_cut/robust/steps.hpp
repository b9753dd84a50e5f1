// SPDX-License-Identifier: Apache-2.0
//
// Walls of which little is seen but a board and what is below it: one plane is fitted through both,
// which leans to the room and hides the step between them.
#pragma once

#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"

namespace convexcut::robust {

// Sets accepted walls upright, with the heights of their cells, and marks them as stepped, where
// they lean to the room, and an upper and a lower part that are each equally deep explain their
// cells far better than that. RT: no allocation, no lock.
void set_stepped_walls_upright(Model& model, PlaneGrids& grids) noexcept;

}  // namespace convexcut::robust
