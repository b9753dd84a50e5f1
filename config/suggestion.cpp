// SPDX-License-Identifier: Apache-2.0
#include "config/suggestion.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <vector>

#include "config/schema.hpp"
#include "config/value_text.hpp"

namespace convexcut::config {
namespace {

constexpr std::size_t kLongestName = 64;  // what is longer is not a slip of the pen

// Levenshtein: insertions, deletions and replacements that make `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (const char c : a) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (c == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row[b.size()];
}

// As edit_distance(), but nothing when a third of the word is wrong.
std::optional<std::size_t> slip(std::string_view written, std::string_view meant) {
  if (written.size() > kLongestName) return std::nullopt;
  const std::size_t distance = edit_distance(written, meant);
  const std::size_t most = std::max<std::size_t>(1, written.size() / 3);
  return distance <= most ? std::optional(distance) : std::nullopt;
}

class Nearest {
 public:
  void offer(std::string_view candidate, std::optional<std::size_t> distance) {
    if (!distance || (distance_ && *distance >= *distance_)) return;
    distance_ = distance;
    name_ = candidate;
  }
  [[nodiscard]] std::string question() const {
    return distance_ ? concat("; did you mean ", name_, "?") : std::string();
  }

 private:
  std::optional<std::size_t> distance_;
  std::string_view name_;
};

}  // namespace

std::string suggest_key(std::string_view unknown) {
  const std::size_t dot = unknown.find('.');
  const bool has_section = dot != std::string_view::npos;
  const std::string_view section = has_section ? unknown.substr(0, dot) : "";
  const std::string_view leaf = has_section ? unknown.substr(dot + 1) : unknown;
  Nearest nearest;
  for (const Key& key : keys()) {
    const auto in_section = slip(section, key.section());
    const auto in_leaf = slip(leaf, key.leaf());
    if (in_section && in_leaf) nearest.offer(key.name, *in_section + *in_leaf);
    // The right key in the wrong section, or without one.
    if (leaf == key.leaf()) nearest.offer(key.name, 2);
  }
  return nearest.question();
}

std::string suggest_section(std::string_view unknown) {
  Nearest nearest;
  for (const Section& section : sections()) {
    nearest.offer(section.name, slip(unknown, section.name));
  }
  return nearest.question();
}

}  // namespace convexcut::config
