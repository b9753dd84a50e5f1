// SPDX-License-Identifier: Apache-2.0
//
// Doubtful faces, one at a time, on surfels made for it: which way each rule decides, and that it
// does not where one of its conditions is missing. That the rules are worth having in furnished
// rooms is measured by bench/accuracy.
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/backs.hpp"
#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"
#include "core/convex_cut/robust/second_look.hpp"

namespace convexcut::robust {
namespace {

constexpr std::size_t kMostSurfels = 10'000;
constexpr float kWallM = 3.0F;  // x of the face
constexpr float kSpacingM = 0.1F;
constexpr float kFloorM = -1.2F;

// From the first on, up to the last and the roundings behind it.
[[nodiscard]] std::vector<float> evenly(float first, float last, float step) {
  std::vector<float> values;
  const auto steps = static_cast<int>((last - first) / step + 1e-3F);
  for (int i = 0; i <= steps; ++i) values.push_back(first + static_cast<float>(i) * step);
  return values;
}

// A face in the plane x = 3, seen from the origin: y from −width/2 on.
struct Face {
  float width_m = 1.0F;
  float bottom_m = kFloorM;
  float top_m = 0.2F;
  std::int32_t points = 20;  // of a surfel
};

class SecondLook : public ::testing::Test {
 protected:
  SecondLook() : grids_(kMostSurfels) {
    model_.floor_z = kFloorM;
    model_.ceiling_z = 1.6F;
  }

  void add(const Vec3f& at, std::int32_t plane, std::int32_t points) {
    Surfel surfel;
    surfel.mean = at;
    surfel.points = points;
    surfel.plane = plane;
    surfel.supported = true;
    model_.surfels.push_back(surfel);
  }
  void build(const Face& face, bool accepted) {
    for (const float y : evenly(-face.width_m / 2, face.width_m / 2, kSpacingM)) {
      for (const float z : evenly(face.bottom_m + kSpacingM / 2, face.top_m, kSpacingM)) {
        add({kWallM, y, z}, 0, face.points);
      }
    }
    Plane plane;
    plane.normal = -Vec3f::UnitX();
    plane.offset = kWallM;
    plane.surfels = static_cast<std::uint32_t>(model_.surfels.size());
    plane.vertical = true;
    plane.accepted = accepted;
    model_.planes.push_back(plane);
    grids_.build(model_);
    const PlaneGrid& grid = grids_.grid(0);
    WallSegment& s = model_.segments.emplace_back();
    s.end = grid.columns;
    s.begin_m = -face.width_m / 2;
    s.end_m = face.width_m / 2;
    s.bottom_m = face.bottom_m;
    s.top_m = face.top_m;
    s.spread2 = model_.noise2;
    s.accepted = accepted;
    for_each_cell([&](Cell& cell) {
      s.closed += cell.seen > 0 ? 1 : 0;
      cell.structure = accepted && cell.seen > 0;
    });
  }
  template <class Visit>
  void for_each_cell(Visit&& visit) {
    grids_.for_each_cell(grids_.grid(0), visit);
  }
  [[nodiscard]] WallSegment& face() { return model_.segments.front(); }
  [[nodiscard]] bool is_accepted(const Sighting& sighting = {}) {
    take_second_look(model_, grids_, sighting);
    return face().accepted;
  }
  // Something close before the cell at (y, z) of the plane, as seen from the lidar.
  void put_before(float y, float z) {
    constexpr float kDepthM = 0.2F;
    add(Vec3f(kWallM, y, z) * ((kWallM - kDepthM) / kWallM), kNoPlane, 20);
  }
  // As many of its cells have something close before them.
  void put_before_cells(std::uint32_t cells) {
    for_each_cell([&](Cell& cell) {
      cell.before = cell.seen > 0 && cells > 0;
      cells -= cell.before ? 1 : 0;
    });
  }
  [[nodiscard]] bool is_enclosed(float y, float z) {
    const PlaneGrid& grid = grids_.grid(0);
    const Vec3f p(kWallM, y, z);
    return grids_.cell(grid, grid.column_of(p), grid.row_of(p)).enclosed;
  }

  Model model_;
  PlaneGrids grids_;
};

TEST_F(SecondLook, KeepsAFaceThatIsNotDoubtful) {
  build({}, true);
  EXPECT_TRUE(is_accepted());
}

TEST_F(SecondLook, RejectsASliver) {
  build({.width_m = 0.1F}, true);
  EXPECT_FALSE(is_accepted());
}

TEST_F(SecondLook, KeepsASliverThatIsTallerThanThings) {
  build({.width_m = 0.1F, .top_m = 1.4F}, true);
  EXPECT_TRUE(is_accepted());
}

TEST_F(SecondLook, RejectsWhatRaysHavePassedWhereItWasSeen) {
  for (const float y : evenly(-0.4F, 0.5F, 0.05F)) {
    for (const float z : evenly(-0.5F, 0.15F, 0.05F)) {
      add(Vec3f(kWallM, y, z) * 1.3F, kNoPlane, 20);
    }
  }
  build({}, true);
  EXPECT_FALSE(is_accepted());
}

// A window, a glass door.
TEST_F(SecondLook, KeepsWhatRaysPassWhereItIsWideOrTall) {
  for (const float y : evenly(-1.5F, 1.5F, 0.05F)) {
    for (const float z : evenly(-0.5F, 0.5F, 0.05F)) {
      add(Vec3f(kWallM, y, z) * 1.3F, kNoPlane, 20);
    }
  }
  build({.width_m = 2.2F}, true);
  face().closed = 39;  // as if it were of few cells: wide enough by itself
  EXPECT_TRUE(is_accepted());
  face().end_m = face().begin_m + 1.0F;
  face().closed = 40;
  EXPECT_TRUE(is_accepted());
  face().closed = 39;
  face().top_m = 1.2F;
  EXPECT_TRUE(is_accepted());
  face().top_m = 0.2F;
  EXPECT_FALSE(is_accepted());
}

TEST_F(SecondLook, RejectsASmallFaceThatWasSeenAlongItself) {
  build({.width_m = 0.6F}, true);
  EXPECT_TRUE(is_accepted({.lidar = {1.0F, -3.0F, 0.0F}}));
  EXPECT_FALSE(is_accepted({.lidar = {2.8F, -3.0F, 0.0F}}));
}

TEST_F(SecondLook, KeepsALargeOrTallFaceThatWasSeenAlongItself) {
  const Sighting along{.lidar = {2.8F, -3.0F, 0.0F}};
  build({.width_m = 0.6F}, true);
  face().closed = 30;
  EXPECT_TRUE(is_accepted(along));
  face().closed = 29;
  face().top_m = 0.9F;
  EXPECT_TRUE(is_accepted(along));
  face().top_m = 0.2F;
  EXPECT_FALSE(is_accepted(along));
}

TEST_F(SecondLook, RejectsAFewCellsThatWereSeenAskew) {
  build({.width_m = 0.2F, .top_m = -0.9F}, true);
  ASSERT_LE(face().closed, 4U);
  EXPECT_TRUE(is_accepted());
  EXPECT_FALSE(is_accepted({.lidar = {0.0F, -3.0F, 0.0F}}));
}

TEST_F(SecondLook, KeepsAFewCellsThatHangOrWereSeenSquare) {
  build({.width_m = 0.2F, .top_m = -0.9F}, true);
  EXPECT_TRUE(is_accepted({.lidar = {0.0F, -1.4F, 0.0F}}));  // 0.906
  face().bottom_m = -0.4F;
  EXPECT_TRUE(is_accepted({.lidar = {0.0F, -3.0F, 0.0F}}));
  face().bottom_m = -0.5F;
  EXPECT_FALSE(is_accepted({.lidar = {0.0F, -3.0F, 0.0F}}));
}

TEST_F(SecondLook, KeepsTheWallBeneathAWindowThatWasSeenAskew) {
  build({.width_m = 0.2F, .top_m = -0.9F}, true);
  face().open = face().closed + 1;
  EXPECT_TRUE(is_accepted({.lidar = {0.0F, -3.0F, 0.0F}}));
  face().top_m = 0.5F;
  EXPECT_FALSE(is_accepted({.lidar = {0.0F, -3.0F, 0.0F}}));
}

TEST_F(SecondLook, RejectsASmallFaceThatIsLow) {
  build({.width_m = 1.0F, .top_m = -0.25F}, true);
  ASSERT_GT(face().closed, 4U);
  face().closed = 25;
  EXPECT_TRUE(is_accepted());
  face().closed = 24;
  face().top_m = kFloorM + 1.01F;
  EXPECT_TRUE(is_accepted());
  face().top_m = kFloorM + 0.99F;
  face().open = 25;  // beneath a window
  EXPECT_TRUE(is_accepted());
  face().open = 24;
  EXPECT_FALSE(is_accepted());
}

TEST_F(SecondLook, RejectsASmallFaceOfFewPointsOnceItWasSeenOften) {
  build({.points = 1}, true);
  EXPECT_TRUE(is_accepted({.revolutions = 2}));
  EXPECT_FALSE(is_accepted({.revolutions = 3}));
}

TEST_F(SecondLook, KeepsALargeOrTallFaceOfFewPoints) {
  build({.points = 1}, true);
  face().closed = 41;
  EXPECT_TRUE(is_accepted({.revolutions = 3}));
  face().closed = 40;
  face().top_m = 1.5F;
  EXPECT_TRUE(is_accepted({.revolutions = 3}));
  face().top_m = 0.2F;
  EXPECT_FALSE(is_accepted({.revolutions = 3}));
}

TEST_F(SecondLook, AcceptsWhatRisesFlatAboveFurniture) {
  build({.bottom_m = 0.8F, .top_m = 1.4F}, false);
  EXPECT_TRUE(is_accepted());
}

TEST_F(SecondLook, DoesNotAcceptWhatIsRoughOrPassedOrFurniture) {
  build({.bottom_m = 0.8F, .top_m = 1.4F}, false);
  face().spread2 = 2 * model_.noise2;
  EXPECT_FALSE(is_accepted());
  face().spread2 = model_.noise2;
  face().open = 1;
  EXPECT_FALSE(is_accepted());
  face().open = 0;
  face().furniture = true;
  EXPECT_FALSE(is_accepted());
}

TEST_F(SecondLook, AcceptsAFaceTallerThanPeopleWithoutACeiling) {
  model_.ceiling_z = std::numeric_limits<float>::infinity();
  build({.width_m = 0.2F, .top_m = 1.8F}, false);
  EXPECT_TRUE(is_accepted());
}

TEST_F(SecondLook, DoesNotAcceptAFaceAsTallAsPeople) {
  model_.ceiling_z = std::numeric_limits<float>::infinity();
  build({.width_m = 0.2F, .top_m = 1.8F}, false);
  face().top_m = 1.0F;
  EXPECT_FALSE(is_accepted());
}

TEST_F(SecondLook, DoesNotAcceptAWideFaceWithoutACeiling) {
  model_.ceiling_z = std::numeric_limits<float>::infinity();
  build({.width_m = 1.0F, .top_m = 1.8F}, false);
  EXPECT_FALSE(is_accepted());
}

TEST_F(SecondLook, AcceptsWhatBeginsWellAboveTheLidar) {
  model_.ceiling_z = std::numeric_limits<float>::infinity();
  build({.bottom_m = 1.0F, .top_m = 1.5F}, false);
  EXPECT_TRUE(is_accepted());
}

TEST_F(SecondLook, DecidesNothingWithoutAFloor) {
  model_.floor_z = -std::numeric_limits<float>::infinity();
  build({.width_m = 0.1F}, true);
  EXPECT_TRUE(is_accepted());
}

TEST_F(SecondLook, RejectsASmallPlaneBehindThings) {
  build({}, true);
  put_before_cells(face().closed / 2);
  reject_what_is_behind(model_, grids_);
  EXPECT_TRUE(face().accepted);
  put_before_cells(face().closed / 2 + 1);
  reject_what_is_behind(model_, grids_);
  EXPECT_FALSE(face().accepted);
  for_each_cell([](const Cell& cell) { EXPECT_FALSE(cell.structure); });
}

TEST_F(SecondLook, RejectsAFewCellsBehindThingsSooner) {
  build({.width_m = 0.5F}, true);
  ASSERT_LE(face().closed, 28U);
  put_before_cells(3 * face().closed / 8);
  reject_what_is_behind(model_, grids_);
  EXPECT_TRUE(face().accepted);
  put_before_cells(3 * face().closed / 8 + 1);
  face().top_m = kFloorM + 2.4F;
  reject_what_is_behind(model_, grids_);
  EXPECT_TRUE(face().accepted);
  face().top_m = kFloorM + 2.3F;
  reject_what_is_behind(model_, grids_);
  EXPECT_FALSE(face().accepted);
}

TEST_F(SecondLook, KeepsALargePlaneBehindThings) {
  build({.width_m = 3.0F}, true);
  for_each_cell([](Cell& cell) { cell.before = true; });
  reject_what_is_behind(model_, grids_);
  EXPECT_TRUE(face().accepted);
}

TEST_F(SecondLook, OneCellBetweenTwoThingsIsABackOfASmallPlane) {
  put_before(0.1F, 0.05F);
  put_before(0.1F, -0.45F);
  build({.width_m = 0.6F}, true);
  ASSERT_LT(model_.planes.front().surfels, 112U);
  mark_backs(model_, grids_);
  EXPECT_TRUE(is_enclosed(0.1F, -0.2F));
}

TEST_F(SecondLook, OneCellBetweenTwoThingsIsNoBackOfALargeWall) {
  put_before(0.1F, 0.35F);
  put_before(0.1F, -0.15F);
  build({.width_m = 4.0F}, true);
  mark_backs(model_, grids_);
  EXPECT_FALSE(is_enclosed(0.1F, 0.1F));
}

TEST_F(SecondLook, AHiddenCellAmongHiddenOnesIsABack) {
  for (const float y : {-0.125F, 0.125F, 0.375F}) {
    for (const float z : {-0.375F, -0.125F, 0.125F}) {
      if (y != 0.125F || z != 0.125F) put_before(y, z);  // nothing above the one in the middle
    }
  }
  build({.width_m = 4.0F}, true);
  mark_backs(model_, grids_);
  EXPECT_TRUE(is_enclosed(0.125F, -0.125F));
  EXPECT_FALSE(is_enclosed(0.625F, -0.125F));
}

}  // namespace
}  // namespace convexcut::robust
