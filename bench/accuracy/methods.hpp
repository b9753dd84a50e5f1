// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/cloud.hpp"
#include "core/geometry.hpp"

namespace convexcut::bench {

// Something that labels one revolution after another.
class Method {
 public:
  Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;
  virtual ~Method() = default;
  // position_m: of the lidar in the world, for methods that use it.
  virtual void label(const CloudView& cloud, const Vec3& position_m, std::span<Label> labels) = 0;
};

struct NamedMethod {
  std::string name;
  std::string description;
  std::function<std::unique_ptr<Method>()> make;
};

// paper, robust, and the three baselines.
[[nodiscard]] std::vector<NamedMethod> compared_methods();
// robust, and robust with one of its parts left out each.
[[nodiscard]] std::vector<NamedMethod> ablations();
// robust that is told the rig's positions.
[[nodiscard]] NamedMethod robust_with_positions();

}  // namespace convexcut::bench
