// SPDX-License-Identifier: Apache-2.0
//
// What RobustCut keeps of rooms of boxes.
#pragma once

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/robust_cut.hpp"
#include "tests/core/convex_cut/robust/labelled_room.hpp"

namespace convexcut::test {

// What was kept of the points on one box (or kWalls, kGhost) in the last of some revolutions.
struct Kept {
  LabelledCloud cloud;
  std::vector<Label> labels;

  [[nodiscard]] double share_of(int box) const {
    return share_of(box, [](const Vec3f&) { return true; });
  }
  // Of the points on it that a test is true of.
  template <class Test>
  [[nodiscard]] double share_of(int box, Test&& is_asked) const {
    const auto& [x, y, z] = cloud.cloud;
    std::size_t all = 0;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (cloud.box[i] != box || !is_asked(Vec3f(x[i], y[i], z[i]))) continue;
      ++all;
      kept += labels[i] == Label::structure ? 1U : 0U;
    }
    EXPECT_GT(all, 30U) << "of box " << box;
    return static_cast<double>(kept) / static_cast<double>(all);
  }
};

inline constexpr std::size_t kMostPoints = 40'000;

// Shares of a box.
inline constexpr double kKept = 0.9;
inline constexpr double kRemoved = 0.15;       // but for the edges on floor and wall
inline constexpr double kMostlyRemoved = 0.3;  // small things have more edge

// The last revolution of a lidar that turns by 12° from one to the next.
[[nodiscard]] inline Kept last_of(RobustCut& robust, const BoxRoom& room, Sight sight,
                                  int revolutions) {
  Kept kept;
  for (int i = 0; i < revolutions; ++i) {
    kept.cloud = revolution_in(room, sight);
    kept.labels.assign(kept.cloud.cloud.size(), Label::other);
    EXPECT_EQ(robust.label(kept.cloud.cloud.view(), kept.labels), CutStatus::ok);
    sight.yaw_deg += 12.0;
    ++sight.seed;
  }
  return kept;
}

[[nodiscard]] inline Kept cut(const BoxRoom& room, const Sight& sight, int revolutions = 1,
                              const RobustParameters& parameters = {}) {
  RobustCut robust(parameters, kMostPoints);
  return last_of(robust, room, sight, revolutions);
}

[[nodiscard]] inline BoxRoom with(const RoomBox& box) {
  BoxRoom room;
  room.boxes = {box};
  return room;
}

}  // namespace convexcut::test
