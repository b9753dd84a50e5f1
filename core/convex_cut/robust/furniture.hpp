// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/convex_cut/robust/model.hpp"

namespace convexcut::robust {

// Takes back accepted segments of model.segments that are furniture, fixtures or people:
// - a front close before a parallel wall that goes on beside or above it, unless it reaches the
//   ceiling (a wardrobe whose top is out of view; a board on the wall);
// - a narrow face beside a rejected one (the side of a bookcase), or one that is rounder than the
//   sensor's noise or uneven (a person's back), unless it reaches the ceiling.
// RT: no allocation.
void reject_furniture(Model& model) noexcept;

}  // namespace convexcut::robust
