// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/scene/shaft.hpp"

#include <algorithm>

namespace convexcut::simulation {

BoxShaft::BoxShaft(const Shaft& shaft) noexcept {
  const auto side = [](double origin, double direction, bool up) {
    const double safe = BoxRay::not_zero(direction);
    return Side{all(static_cast<float>(origin)), all(static_cast<float>(1.0 / safe)),
                (safe > 0.0) == up};
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto index = static_cast<Eigen::Index>(axis);
    up_[axis] = side(shaft.origins.high[index], shaft.directions.high[index], true);
    down_[axis] = side(shaft.origins.low[index], shaft.directions.low[index], false);
  }
}

void InShaft::finish() {
  constexpr std::size_t kLanes = EightBoxes::kLanes;
  std::ranges::sort(found_, {}, &Found::order);
  groups_.resize((found_.size() + kLanes - 1) / kLanes);
  for (std::size_t first = 0; first < found_.size(); first += kLanes) {
    Group& group = groups_[first / kLanes];
    group.nearest = std::bit_cast<float>(static_cast<std::uint32_t>(found_[first].order >> 32U));
    group.boxes = EightBoxes::nothing();
    const std::size_t end = std::min(first + kLanes, found_.size());
    for (std::size_t i = first; i < end; ++i) {
      group.boxes.copy(i - first, *found_[i].boxes, found_[i].lane);
      group.things[i - first] = static_cast<std::uint32_t>(found_[i].order);
    }
  }
}

}  // namespace convexcut::simulation
