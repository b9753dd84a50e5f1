// SPDX-License-Identifier: Apache-2.0
//
// Which leaning walls are a board and the wall below it: cells made for it, and each condition
// missing once. That the rule is worth having in furnished rooms is measured by bench/accuracy.
#include <cstdint>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/fixtures.hpp"
#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"
#include "core/convex_cut/robust/steps.hpp"

namespace convexcut::robust {
namespace {

class SteppedWalls : public ::testing::Test {
 protected:
  static constexpr std::size_t kMostSurfels = 1'000;
  static constexpr float kWallM = 3.0F;  // x of its foot
  static constexpr float kFloorM = -1.25F;

  static constexpr std::int32_t kRows = 8;
  static constexpr std::int32_t kColumns = 3;
  static constexpr std::int32_t kPoints = 50;  // of a cell

  SteppedWalls() : grids_(kMostSurfels) { model_.floor_z = kFloorM; }

  // One accepted plane, whose top is nearer by `lean` a metre.
  void build(float lean) {
    for (std::int32_t row = 0; row < kRows; ++row) {
      for (std::int32_t column = 0; column < kColumns; ++column) {
        Surfel& surfel = model_.surfels.emplace_back();
        surfel.mean = {kWallM, (static_cast<float>(column) + 0.5F) * kCellM,
                       kFloorM + (static_cast<float>(row) + 0.5F) * kCellM};
        surfel.points = kPoints;
        surfel.plane = 0;
        surfel.supported = true;
      }
    }
    Plane& plane = model_.planes.emplace_back();
    plane.normal = Vec3f(-1.0F, 0.0F, -lean).normalized();
    plane.offset = -plane.normal.dot(Vec3f(kWallM, 0.0F, 0.0F));
    plane.surfels = static_cast<std::uint32_t>(model_.surfels.size());
    plane.vertical = true;
    plane.accepted = true;
    grids_.build(model_);
    grids_.for_each_cell(grids_.grid(0), [](Cell& cell) { cell.structure = cell.seen > 0; });
  }
  // Puts the cells of rows [first, end) so far before the upright wall.
  void put(std::int32_t first, std::int32_t end, float proud_m) {
    for_each_cell(first, end, [&](Cell& cell, const Vec3f& on_plane) {
      const float height_m = model_.planes[0].height_of({kWallM - proud_m, 0.0F, on_plane.z()});
      cell.height_sum_m = static_cast<float>(kPoints) * height_m;
    });
  }
  // Of the seen cells, from the lowest row on.
  template <class Visit>
  void for_each_cell(std::int32_t first, std::int32_t end, Visit&& visit) {
    const PlaneGrid& grid = grids_.grid(0);
    std::int32_t seen_rows = 0;
    for (std::int32_t row = 0; row < grid.rows; ++row) {
      bool any = false;
      for (std::int32_t column = 0; column < grid.columns; ++column) {
        Cell& cell = grids_.cell(grid, column, row);
        if (cell.seen == 0) continue;
        any = true;
        if (seen_rows >= first && seen_rows < end) {
          visit(cell, grid.centre(model_.planes[0], column, row));
        }
      }
      seen_rows += any ? 1 : 0;
    }
  }
  [[nodiscard]] bool is_stepped() {
    set_stepped_walls_upright(model_, grids_);
    return model_.planes[0].stepped;
  }
  void board_from(std::int32_t row, float proud_m = 0.03F) {
    put(0, row, 0.0F);
    put(row, kRows, proud_m);
  }

  Model model_;
  PlaneGrids grids_;
};

TEST_F(SteppedWalls, SetsABoardAndTheWallBelowItUpright) {
  build(0.02F);
  board_from(5);
  ASSERT_TRUE(is_stepped());
  EXPECT_NEAR(model_.planes[0].normal.z(), 0.0F, 1e-5F);  // to the second order
  float wall_m = 0.0F;
  for_each_cell(0, 1, [&](const Cell& cell, const Vec3f&) { wall_m = cell.mean_m(); });
  for_each_cell(0, 5,
                [&](const Cell& cell, const Vec3f&) { EXPECT_NEAR(cell.mean_m(), wall_m, 1e-4F); });
  for_each_cell(5, kRows, [&](const Cell& cell, const Vec3f&) {
    EXPECT_NEAR(cell.mean_m(), wall_m + 0.03F, 1e-4F);
  });
}

// Of fewer surfels than a wall needs for a face otherwise.
TEST_F(SteppedWalls, MakeTheBoardAFixture) {
  build(0.02F);
  board_from(5);
  Fixtures().find(model_, grids_);
  for_each_cell(1, 5, [](const Cell& cell, const Vec3f&) { EXPECT_EQ(cell.layer_m, 0.0F); });
  for_each_cell(5, kRows,
                [](const Cell& cell, const Vec3f&) { EXPECT_NEAR(cell.layer_m, 0.03F, 1e-4F); });
}

// By 12 mm, as plaster is.
TEST_F(SteppedWalls, LeavesAnUnevenWallThatLeans) {
  build(0.03F);
  for_each_cell(0, kRows, [column = 0](Cell& cell, const Vec3f&) mutable {
    cell.height_sum_m = (column++ % 2 == 0 ? 0.012F : -0.012F) * static_cast<float>(kPoints);
  });
  EXPECT_FALSE(is_stepped());
}

TEST_F(SteppedWalls, LeavesAWallThatHardlyLeans) {
  build(0.004F);
  board_from(5);
  EXPECT_FALSE(is_stepped());
}

TEST_F(SteppedWalls, LeavesASlope) {
  build(0.06F);
  board_from(5, 0.08F);
  EXPECT_FALSE(is_stepped());
}

// What is proud below is something before the wall.
TEST_F(SteppedWalls, LeavesAStepOfTheLowerPart) {
  build(-0.02F);
  board_from(5, -0.03F);
  EXPECT_FALSE(is_stepped());
}

TEST_F(SteppedWalls, LeavesAStepAsFlatAsTheNoise) {
  build(0.008F);
  board_from(5, 0.015F);
  EXPECT_FALSE(is_stepped());
}

TEST_F(SteppedWalls, LeavesWhatTwoCellsTell) {
  build(0.02F);
  put(0, kRows - 1, 0.0F);
  put(kRows - 1, kRows, 0.04F);
  for_each_cell(kRows - 1, kRows,
                [column = 0](Cell& cell, const Vec3f&) mutable { cell.structure = column++ < 2; });
  EXPECT_FALSE(is_stepped());
}

TEST_F(SteppedWalls, DoesNotAskCellsAtTheFloor) {
  build(0.02F);
  board_from(5);
  put(0, 1, 0.2F);
  EXPECT_TRUE(is_stepped());
}

TEST_F(SteppedWalls, DoesNotAskWhatLiesBetweenShelves) {
  build(0.02F);
  board_from(5);
  for_each_cell(3, kRows, [column = 0](Cell& cell, const Vec3f&) mutable {
    if (column++ % kColumns != 0) return;
    cell.height_sum_m += 0.1F * static_cast<float>(kPoints);
    cell.enclosed = true;
  });
  EXPECT_TRUE(is_stepped());
}

TEST_F(SteppedWalls, LeavesFurniture) {
  build(0.02F);
  board_from(5);
  model_.planes[0].accepted = false;
  EXPECT_FALSE(is_stepped());
}

}  // namespace
}  // namespace convexcut::robust
