// SPDX-License-Identifier: Apache-2.0
#include "config/suggestion.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "config/schema.hpp"
#include "config/value_text.hpp"

namespace convexcut::config {
namespace {

constexpr std::size_t kLongestName = 64;  // what is longer is not a slip of the pen

// Optimal string alignment: insertions, deletions, replacements and swaps of neighbours that make
// `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last;
  std::vector<std::size_t> last(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::vector<std::size_t> row(b.size() + 1);
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      row[j + 1] = std::min({last[j] + (a[i] == b[j] ? 0 : 1), row[j] + 1, last[j + 1] + 1});
      if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j]) {
        row[j + 1] = std::min(row[j + 1], before_last[j - 1] + 1);
      }
    }
    before_last = std::exchange(last, std::move(row));
  }
  return last[b.size()];
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

std::string suggest(std::string_view unknown, std::span<const std::string_view> known) {
  Nearest nearest;
  for (const std::string_view each : known) nearest.offer(each, slip(unknown, each));
  return nearest.question();
}

}  // namespace convexcut::config
