// SPDX-License-Identifier: Apache-2.0
//
// Thin boards that cover more of a wall than is seen of it, or turn the plane fitted through both.
// How often the rules are right in furnished rooms is measured by bench/accuracy.
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/robust_cut.hpp"
#include "tests/core/convex_cut/robust/room_cut.hpp"

namespace convexcut {
namespace {

using test::BoxRoom;
using test::cut;
using test::Kept;
using test::kKept;
using test::kMostlyRemoved;

// Two centimetres thick, and a bench hides the wall below: the plane that fits both is turned, so
// that no step is left between them.
TEST(RobustBoards, RemovesAThinBoardAtOneEndOfAWall) {
  BoxRoom room;
  room.boxes = {{{3.98, -2.6, 0.85}, {4.0, -1.0, 1.45}}, {{3.66, -3.0, -1.2}, {4.0, 3.0, 0.75}}};
  for (const std::uint64_t seed : {1U, 101U, 201U}) {
    const Kept kept = cut(room, {.tilt_deg = 30.0, .noise_m = 0.01, .seed = seed}, 12);
    EXPECT_LT(kept.share_of(0), kMostlyRemoved) << seed;
    EXPECT_GT(kept.share_of(test::kWalls), kKept) << seed;
  }
}

// Cupboards hide the wall beside the board, and the view ends above it: no door or window has its
// head as low as the board's lower edge, so the wall is what goes on below.
TEST(RobustBoards, RemovesABoardThatCoversMostOfWhatIsSeenOfItsWall) {
  BoxRoom room;
  room.boxes = {{{3.97, -1.5, -0.3}, {4.0, 1.5, 1.0}},
                {{3.6, -3.0, -1.2}, {4.0, -1.5, 1.8}},
                {{3.6, 1.5, -1.2}, {4.0, 3.0, 1.8}}};
  for (const std::uint64_t seed : {1U, 101U, 201U}) {
    const Kept kept = cut(room, {.tilt_deg = 0.0, .noise_m = 0.01, .seed = seed}, 6);
    EXPECT_LT(kept.share_of(0), kMostlyRemoved) << seed;
    EXPECT_GT(kept.share_of(test::kWalls), kKept) << seed;
  }
}

// Between cupboards hardly more is seen of the wall than of the board: the plane that fits both
// leans to the room.
TEST(RobustBoards, RemovesABoardOnANarrowPartOfAWall) {
  BoxRoom room;
  room.boxes = {{{3.97, -0.55, -0.3}, {4.0, 0.55, 1.0}},
                {{3.6, -3.0, -1.2}, {4.0, -0.55, 1.8}},
                {{3.6, 0.55, -1.2}, {4.0, 3.0, 1.8}}};
  const auto is_below = [](const Vec3f& p) {
    return p.x() > 3.8F && std::abs(p.y()) < 0.5F && p.z() > -1.0F && p.z() < -0.4F;
  };
  for (const std::uint64_t seed : {1U, 101U, 201U}) {
    const Kept kept = cut(room, {.seed = seed}, 6);
    EXPECT_LT(kept.share_of(0), kMostlyRemoved) << seed;
    EXPECT_GT(kept.share_of(test::kWalls, is_below), kKept) << seed;
  }
}

}  // namespace
}  // namespace convexcut
