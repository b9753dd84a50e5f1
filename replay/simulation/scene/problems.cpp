// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/scene/problems.hpp"

#include <algorithm>

#include "replay/simulation/scene/scene.hpp"

namespace convexcut::simulation {

void Problems::report(std::size_t line, std::string_view key, std::string_view what) {
  std::string text = file_;
  if (line != 0) text.append(":").append(std::to_string(line));
  if (!key.empty()) text.append(": ").append(key);
  problems_.push_back({line, text.append(": ").append(what)});
}

void Problems::throw_if_any() const {
  if (problems_.empty()) return;
  std::vector<Problem> in_order = problems_;
  std::ranges::stable_sort(in_order, {}, &Problem::line);
  std::string all;
  for (const Problem& problem : in_order) {
    if (!all.empty()) all += '\n';
    all += problem.text;
  }
  throw SceneError(all);
}

}  // namespace convexcut::simulation
