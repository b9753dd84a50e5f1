// SPDX-License-Identifier: Apache-2.0
//
// Images behind mirrors, and rooms that are none.
#include <gtest/gtest.h>

#include "tests/core/convex_cut/robust/room_cut.hpp"

namespace convexcut {
namespace {

using test::BoxRoom;
using test::cut;
using test::Kept;
using test::kKept;
using test::kRemoved;

// About half of what the mirror shows is seen without it as well, the rest is above the view.
TEST(RobustMirrors, RemovesAMirrorImageThatIsPartlyOutOfView) {
  BoxRoom room;
  room.has_mirror = true;
  room.mirror = {-1.0, 1.0, -0.1, 0.8};
  const Kept kept = cut(room, {});
  EXPECT_LT(kept.share_of(test::kGhost), kRemoved);
  EXPECT_GT(kept.share_of(test::kWalls), 0.98);
}

// Its end is as far behind the hole as the room's is before it; but a cupboard stands in one of
// them.
TEST(RobustMirrors, KeepsARoomBehindAHoleThatIsAsLargeAsThisOne) {
  BoxRoom room;
  room.walls = {{-4.0, -9.0, -1.2}, {4.0, 3.0, 1.6}};
  room.boxes = {{{-4.0, -3.1, -1.2}, {-1.0, -3.0, 1.6}},
                {{1.0, -3.1, -1.2}, {4.0, -3.0, 1.6}},
                {{-1.0, -3.1, -1.2}, {1.0, -3.0, -0.6}},
                {{-1.6, -7.5, -1.2}, {-0.4, -7.1, 0.8}}};
  EXPECT_GT(cut(room, {}).share_of(test::kWalls), 0.98);
}

// A third of its end is as far behind the hole as the room's end is before it.
TEST(RobustMirrors, KeepsARoomBehindAHoleThatIsPartlyAsThisOne) {
  BoxRoom room;
  room.walls = {{-4.0, -9.0, -1.2}, {4.0, 3.0, 1.6}};
  room.boxes = {{{-4.0, -9.0, -1.2}, {1.0, -7.5, 1.6}},
                {{-4.0, -3.1, -1.2}, {-1.0, -3.0, 1.6}},
                {{1.0, -3.1, -1.2}, {4.0, -3.0, 1.6}},
                {{-1.0, -3.1, -1.2}, {1.0, -3.0, -0.6}}};
  const Kept kept = cut(room, {});
  EXPECT_GT(kept.share_of(0), kKept);
  EXPECT_GT(kept.share_of(test::kWalls), 0.98);
}

}  // namespace
}  // namespace convexcut
