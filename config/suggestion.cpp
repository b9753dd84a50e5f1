// SPDX-License-Identifier: Apache-2.0
#include "config/suggestion.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "config/schema.hpp"

namespace convexcut::config {
namespace {

constexpr std::size_t kLongestName = 64;  // what is longer is not a slip of the pen

// Levenshtein: insertions, deletions and replacements that make `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row[b.size()];
}

class Nearest {
 public:
  explicit Nearest(std::string_view unknown) : unknown_(unknown), best_(unknown.size() / 3 + 1) {}

  void offer(std::string_view candidate, std::size_t distance) {
    if (distance >= best_) return;
    best_ = distance;
    name_ = candidate;
  }
  void offer(std::string_view candidate) { offer(candidate, edit_distance(unknown_, candidate)); }
  [[nodiscard]] std::string_view name() const { return name_; }

 private:
  std::string_view unknown_;
  std::size_t best_;
  std::string_view name_;
};

}  // namespace

std::string suggestion(std::string_view unknown) {
  if (unknown.size() > kLongestName) return {};
  Nearest nearest(unknown);
  const std::size_t dot = unknown.find('.');
  for (const Section& section : sections()) {
    if (dot == std::string_view::npos) nearest.offer(section.name);
  }
  for (const Key& key : keys()) {
    if (dot != std::string_view::npos) nearest.offer(key.name);
    // The right key in the wrong section, or without one.
    const bool same_leaf =
        unknown.substr(dot == std::string_view::npos ? 0 : dot + 1) == key.leaf();
    if (same_leaf) nearest.offer(key.name, 1);
  }
  if (nearest.name().empty()) return {};
  return "; did you mean " + std::string(nearest.name()) + "?";
}

}  // namespace convexcut::config
