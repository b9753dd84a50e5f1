// SPDX-License-Identifier: Apache-2.0
//
// Which parts of level planes are structure, on surfels and passages made for it. That the rules
// are worth having in furnished rooms is measured by bench/accuracy.
#include <cstdint>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/flat_surfaces.hpp"
#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"

namespace convexcut::robust {
namespace {

constexpr std::int32_t kCeiling = 0;
constexpr std::int32_t kUnderside = 1;
constexpr float kCeilingM = 1.4F;
constexpr float kUndersideM = 1.15F;

class FlatSurface : public ::testing::Test {
 protected:
  FlatSurface() : grids_(10'000) {
    add_plane(kCeilingM);
    add_plane(kUndersideM);
  }
  void add_plane(float z_m) {
    Plane plane;
    plane.normal = -Vec3f::UnitZ();
    plane.offset = z_m;
    plane.surfels = 100;
    model_.planes.push_back(plane);
  }
  // What is seen of a plane: so long along x, 0.3 m wide.
  void see(std::int32_t plane, float begin_m, float end_m, float middle_m = 0.0F) {
    constexpr float kSpacingM = 0.1F;
    const float z_m = plane == kCeiling ? kCeilingM : kUndersideM;
    const int last = static_cast<int>((end_m - begin_m) / kSpacingM);
    for (int i = 0; i <= last; ++i) {
      for (const float y : {-0.15F, -0.05F, 0.05F, 0.15F}) {
        Surfel surfel;
        surfel.mean = {begin_m + kSpacingM * static_cast<float>(i), middle_m + y, z_m};
        surfel.points = 20;
        surfel.plane = plane;
        surfel.supported = true;
        model_.surfels.push_back(surfel);
      }
    }
  }
  // Nowhere that rays to it would pass the underside's plane close to what is seen of that.
  void see_ceiling() {
    for (const float y : {-3.0F, -2.7F, 2.7F, 3.0F}) see(kCeiling, -3.0F, 4.0F, y);
  }
  // Rays pass the underside's plane beside what is seen of it, as far as x = end_m.
  void find(float passed_to_m) {
    grids_.build(model_);
    const PlaneGrid& grid = grids_.grid(kUnderside);
    for (std::int32_t row = 0; row < grid.rows; ++row) {
      for (std::int32_t column = 0; column < grid.columns; ++column) {
        Cell& cell = grids_.cell(grid, column, row);
        const Vec3f centre = grid.centre(model_.planes[kUnderside], column, row);
        if (cell.seen == 0 && centre.x() < passed_to_m) cell.passed = kPassed;
      }
    }
    surfaces_.find(model_, grids_, Vec3f::Zero(), true);
  }
  [[nodiscard]] bool is_structure(float x_m) {
    const PlaneGrid& grid = grids_.grid(kUnderside);
    const Vec3f p(x_m, 0.0F, kUndersideM);
    return grids_.cell(grid, grid.column_of(p), grid.row_of(p)).structure;
  }

  Model model_;
  PlaneGrids grids_;
  FlatSurfaces surfaces_;
};

TEST_F(FlatSurface, KeepsTheEndOfABeamBesideWhichNothingIsSeen) {
  see_ceiling();
  see(kUnderside, -3.0F, 1.0F);
  see(kUnderside, 2.5F, 4.0F);
  find(1.5F);
  EXPECT_EQ(model_.ceiling_z, kCeilingM);
  EXPECT_TRUE(is_structure(0.1F));
  EXPECT_TRUE(is_structure(3.1F));
}

// A shelf's underside is seen so too.
TEST_F(FlatSurface, RemovesTheSameWhereNoBeamGoesOn) {
  see_ceiling();
  see(kUnderside, 2.5F, 4.0F);
  find(1.5F);
  EXPECT_EQ(model_.ceiling_z, kCeilingM);
  EXPECT_FALSE(is_structure(3.1F));
}

// Beside the beam's line.
TEST_F(FlatSurface, RemovesTheSameBesideABeam) {
  see_ceiling();
  see(kUnderside, -3.0F, 1.0F, 1.0F);
  see(kUnderside, 2.5F, 4.0F);
  find(1.5F);
  EXPECT_FALSE(is_structure(3.1F));
}

}  // namespace
}  // namespace convexcut::robust
