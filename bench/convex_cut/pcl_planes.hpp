// SPDX-License-Identifier: Apache-2.0
//
// What users of PCL do to find walls, floor and ceiling: planes by RANSAC, one after another. Not
// the same answer as Convex Cut's (a cupboard's front is a plane too), but the same purpose.
#pragma once

#include <functional>
#include <optional>

#include "core/cloud.hpp"

namespace convexcut::bench {

// Takes the largest plane's points (within 5 cm) out of the cloud, again and again, until a tenth
// of the points is left or ten planes are found. PCL's own copy of the cloud is made here, not in
// what is measured. Nothing where the program was built without PCL.
[[nodiscard]] std::optional<std::function<void()>> pcl_planes(const CloudView& cloud);

}  // namespace convexcut::bench
