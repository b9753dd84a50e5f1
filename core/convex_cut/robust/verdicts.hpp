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
  as_now,           // what the revolution says of each point
  structure,        // so far, whatever the revolution says
  structure_again,  // as before it left the window, also where no surface is known yet
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
    if (!is_structure) {
      if (share_ <= kMostOfObject) return Verdict::as_now;
      return is_back_ ? Verdict::structure_again : Verdict::structure;
    }
    const bool is_believed = was_structure && !is_back_;
    return !is_believed && share_ < kLeastOfStructure ? Verdict::object : Verdict::as_now;
  }

  [[nodiscard]] bool is_empty() const noexcept { return revolutions_ == 0; }
  // Whether they tell enough of a place to be remembered when it goes out of the window.
  [[nodiscard]] bool are_settled() const noexcept { return revolutions_ >= kSettled; }
  // Of a place that is in the window again: things may have been moved, so that what was decided of
  // it weighs half as much. But twice in a row is not enough for an object to become structure:
  // what is seen of it at first is as little as it was when nothing was known.
  [[nodiscard]] Verdicts back() const noexcept {
    Verdicts verdicts = *this;
    verdicts.revolutions_ =
        std::min(verdicts.revolutions_, static_cast<std::uint8_t>(kRemembered / 2));
    verdicts.is_back_ = !is_empty();
    return verdicts;
  }

 private:
  static constexpr int kRemembered = 16;  // revolutions; older ones fade
  static constexpr int kSettled = 4;
  static constexpr float kMostOfObject = 0.5F;
  static constexpr float kLeastOfStructure = 0.3F;

  float share_ = 0.0F;  // of the revolutions in which it was structure
  std::uint8_t revolutions_ = 0;
  bool last_ = true;
  bool is_back_ = false;
};

}  // namespace convexcut::robust
