// SPDX-License-Identifier: Apache-2.0
#include "bench/convex_cut/pcl_planes.hpp"

namespace convexcut::bench {

std::optional<std::function<void()>> pcl_planes(const CloudView& /*cloud*/) { return std::nullopt; }

}  // namespace convexcut::bench
