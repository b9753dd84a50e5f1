// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace convexcut::daemon {

// Keeps the texts that a message refers to: Cyclone DDS's C types hold char*, which are only read.
class TextPool {
 public:
  // Valid until clear().
  [[nodiscard]] char* keep(std::string_view text) { return texts_.emplace_back(text).data(); }
  void clear() noexcept { texts_.clear(); }

 private:
  std::deque<std::string> texts_;  // its elements stay where they are
};

// A sequence that refers to a vector of ours (_release false: Cyclone DDS only reads it).
template <class Sequence, class Element>
[[nodiscard]] Sequence sequence_of(std::vector<Element>& elements) noexcept {
  const auto size = static_cast<std::uint32_t>(elements.size());
  return {size, size, elements.data(), false};
}

}  // namespace convexcut::daemon
