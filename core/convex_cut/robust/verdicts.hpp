// SPDX-License-Identifier: Apache-2.0
//
// What was decided of a voxel in the revolutions before. Planes are found anew in each revolution,
// so where a wall is mostly hidden the newest decision is partly chance; the mean of many is not.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

namespace convexcut::robust {

enum class Verdict : std::uint8_t {
  as_now,     // what the revolution says of each point
  structure,  // so far, whatever the revolution says
  object,
};

class Verdicts {
 public:
  // Adds whether most of the revolution's points in the voxel are structure, and tells what they
  // are to be taken for. The first revolution decides alone. What was no structure before becomes
  // one when it has been it twice in a row or in a third of the time: in a lidar's first
  // revolutions much is out of view that shows what a surface is.
  [[nodiscard]] Verdict add(bool is_structure) noexcept {
    revolutions_ = static_cast<std::uint8_t>(std::min(revolutions_ + 1, kRemembered));
    share_ += ((is_structure ? 1.0F : 0.0F) - share_) / static_cast<float>(revolutions_);
    const bool was_structure = std::exchange(last_, is_structure);
    if (!is_structure) return share_ > kMostOfObject ? Verdict::structure : Verdict::as_now;
    return !was_structure && share_ < kLeastOfStructure ? Verdict::object : Verdict::as_now;
  }

 private:
  static constexpr int kRemembered = 16;  // revolutions; older ones fade
  static constexpr float kMostOfObject = 0.5F;
  static constexpr float kLeastOfStructure = 0.3F;

  float share_ = 0.0F;  // of the revolutions in which it was structure
  std::uint8_t revolutions_ = 0;
  bool last_ = true;
};

}  // namespace convexcut::robust
