// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"

namespace convexcut::robust {

// Marks the cells of accepted walls that are seen between boards or books close before them: the
// back of a bookcase, which is too near to its wall to be told from it. RT: no allocation.
void mark_backs(const Model& model, PlaneGrids& grids) noexcept;

}  // namespace convexcut::robust
