// SPDX-License-Identifier: Apache-2.0
//
// What lies flat on a wall or in it, point by point: edges of boards, panes of glass, doors, and
// noise. How much that is worth in furnished rooms is measured by bench/accuracy.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/robust_cut.hpp"
#include "tests/core/convex_cut/robust/room_cut.hpp"

namespace convexcut {
namespace {

using test::BoxRoom;
using test::cut;
using test::Kept;
using test::kKept;
using test::LabelledCloud;
using test::with;

// Voxels of 0.2 m hold both of them; how well they are told depends on where in one the edge lies.
TEST(RobustLayers, TellsABoardFromItsWallUpToItsEdges) {
  const std::vector<double> shifts_m{0.0, 0.05, 0.1, 0.15};
  double wall = 0.0;
  double board = 0.0;
  for (const double shift_m : shifts_m) {
    constexpr double kBesideM = 0.1;
    const double low = -0.4 + shift_m;
    const double high = 0.6 + shift_m;
    const Kept kept = cut(with({{3.96, low, -0.5}, {4.0, high, 0.7}}), {.noise_m = 0.01}, 4);
    const auto is_beside = [&](const Vec3f& p) {
      const auto y = static_cast<double>(p.y());
      return p.x() > 3.9F && p.z() > -0.4F && p.z() < 0.6F &&
             std::min(std::abs(y - low), std::abs(y - high)) < kBesideM;
    };
    wall += kept.share_of(test::kWalls, is_beside) / static_cast<double>(shifts_m.size());
    board += kept.share_of(0, is_beside) / static_cast<double>(shifts_m.size());
  }
  EXPECT_GT(wall, 0.8);
  EXPECT_LT(board, 0.08);
}

// Noise of 4 cm, so that there is enough of it.
TEST(RobustLayers, KeepsNoiseBehindAWall) {
  const Kept kept = cut({}, {.noise_m = 0.04}, 4);
  const auto is_behind = [](const Vec3f& p) {
    return p.x() > 4.058F && p.x() < 4.074F && std::abs(p.y()) < 2.5F && p.z() > -1.0F &&
           p.z() < 1.0F;
  };
  EXPECT_GT(kept.share_of(test::kWalls, is_behind), kKept);
}

// Every other firing goes through the pane.
[[nodiscard]] LabelledCloud through_glass(const BoxRoom& glazed, const BoxRoom& open,
                                          const test::Sight& sight) {
  constexpr std::size_t kLasers = 32;
  LabelledCloud seen = test::revolution_in(glazed, sight);
  const LabelledCloud passed = test::revolution_in(open, sight);
  for (std::size_t i = 0; i < seen.cloud.size(); ++i) {
    if (i / kLasers % 2 == 0) continue;
    seen.cloud.x[i] = passed.cloud.x[i];
    seen.cloud.y[i] = passed.cloud.y[i];
    seen.cloud.z[i] = passed.cloud.z[i];
    seen.box[i] = passed.box[i];
  }
  return seen;
}

[[nodiscard]] Kept kept_of_glazed(const BoxRoom& open, const test::RoomBox& pane,
                                  std::uint64_t first_seed = 1) {
  BoxRoom glazed = open;
  glazed.boxes.push_back(pane);
  RobustCut robust({}, test::kMostPoints);
  Kept kept;
  for (std::uint64_t seed = first_seed; seed < first_seed + 6; ++seed) {
    kept.cloud = through_glass(glazed, open, {.noise_m = 0.01, .seed = seed});
    kept.labels.assign(kept.cloud.cloud.size(), Label::other);
    EXPECT_EQ(robust.label(kept.cloud.cloud.view(), kept.labels), CutStatus::ok);
  }
  return kept;
}

TEST(RobustLayers, KeepsAPaneOfGlassInARecess) {
  BoxRoom open;
  open.boxes = {{{2.0, -3.0, -1.2}, {2.1, -0.8, 1.6}},
                {{2.0, 0.8, -1.2}, {2.1, 3.0, 1.6}},
                {{2.0, -0.8, -0.1}, {2.1, 0.8, 1.6}}};
  const Kept kept = kept_of_glazed(open, {{2.03, -0.8, -1.2}, {2.05, 0.8, -0.1}});
  EXPECT_GT(kept.share_of(3), 0.8);
  EXPECT_GT(kept.share_of(2), 0.8);
}

// There is more of the glass than of what frames it, which is proud of it as boards are.
TEST(RobustLayers, KeepsTheFrameOfAGlazedWall) {
  BoxRoom open;
  open.boxes = {{{2.0, -3.0, -1.2}, {2.1, -1.8, 1.6}},
                {{2.0, 1.8, -1.2}, {2.1, 3.0, 1.6}},
                {{2.0, -1.8, 0.0}, {2.1, 1.8, 1.6}}};
  for (const std::uint64_t seed : {1U, 101U, 201U, 301U}) {
    const Kept kept = kept_of_glazed(open, {{2.02, -1.8, -1.2}, {2.04, 1.8, 0.0}}, seed);
    EXPECT_GT(kept.share_of(2), 0.8) << seed;
    EXPECT_GT(kept.share_of(3), 0.8) << seed;
  }
}

// Through an open door. Behind it is a room as wide as this one, and nothing parallel near the
// wall.
TEST(RobustLayers, KeepsTheJambOfAnOpenDoor) {
  for (const float thick_m : {0.12F, 0.2F}) {
    const double end = 2.0 + static_cast<double>(thick_m);
    BoxRoom room;
    room.walls = {{-3.0, -3.0, -1.2}, {6.0, 3.0, 1.6}};
    room.boxes = {{{2.0, -3.0, -1.2}, {end, 0.4, 1.6}},
                  {{2.0, 1.3, -1.2}, {end, 3.0, 1.6}},
                  {{2.0, 0.4, 0.85}, {end, 1.3, 1.6}}};
    const auto is_jamb = [&](const Vec3f& p) {
      return p.x() > 1.92F + thick_m && p.x() < 1.98F + thick_m && p.z() > -1.1F && p.z() < 0.8F;
    };
    for (const std::uint64_t seed : {1U, 101U, 201U}) {
      const Kept kept = cut(room, {.noise_m = 0.01, .seed = seed}, 4);
      EXPECT_GT(kept.share_of(1, is_jamb), 0.75) << thick_m << " m thick, seed " << seed;
    }
  }
}

TEST(RobustLayers, RemovesABoardThatIsThinnerThanTheNoise) {
  const Kept kept = cut(with({{3.985, -1.0, -0.5}, {4.0, 1.0, 0.7}}), {.noise_m = 0.02}, 8);
  EXPECT_LT(kept.share_of(0), test::kMostlyRemoved);
  EXPECT_GT(kept.share_of(test::kWalls), kKept);
}

}  // namespace
}  // namespace convexcut
