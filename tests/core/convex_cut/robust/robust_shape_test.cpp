// SPDX-License-Identifier: Apache-2.0
//
// Shapes of voxels where surfaces meet. That their principal axes are right is
// robust_shape_kernels_test's.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/shape.hpp"
#include "core/convex_cut/robust/voxel_map.hpp"

namespace convexcut::robust {
namespace {

constexpr std::int32_t kSpacingMm = 80;
constexpr int kAlong = 5;    // points of a row
constexpr int kHeight = 12;  // rows

class RobustShape : public ::testing::Test {
 protected:
  RobustShape() : map_(1'000) {}

  void add(const Vec3f& p) {
    const Lattice place = place_of(p);
    const std::int32_t index = map_.find_or_add(key_of(place));
    ASSERT_NE(index, VoxelMap::kNone);
    const Vec3f from_centre = (p - centre_of(place)) * 1e3F;
    const auto mm = [](float value) { return static_cast<std::int32_t>(std::lround(value)); };
    map_.voxels()[static_cast<std::size_t>(index)].moments.add_mm(
        mm(from_centre.x()), mm(from_centre.y()), mm(from_centre.z()));
  }
  // From a corner along two axes, the long one second; six or nine points in a voxel: too few for
  // it alone.
  void add_face(const Vec3f& corner, const Vec3f& along, const Vec3f& up = Vec3f::UnitZ()) {
    for (int i = 0; i < kAlong; ++i) {
      for (int k = 0; k < kHeight; ++k) {
        const auto mm = [](int n) { return 1e-3F * static_cast<float>(n * kSpacingMm); };
        add(corner + along * mm(i) + up * mm(k));
      }
    }
  }
  [[nodiscard]] const Voxel& shaped_at(const Vec3f& p) {
    std::vector<std::uint32_t> all(map_.voxels().size());
    std::iota(all.begin(), all.end(), 0U);
    for (std::size_t begin = 0; begin < all.size(); begin += kShapesAtOnce) {
      const std::size_t count = std::min<std::size_t>(kShapesAtOnce, all.size() - begin);
      take_shapes(map_, std::span(all).subspan(begin, count));
    }
    return map_.voxels()[static_cast<std::size_t>(map_.find_or_add(key_of(place_of(p))))];
  }

  VoxelMap map_;
};

[[nodiscard]] Vec3f edge() { return {0.13F, 0.13F, 0.02F}; }
[[nodiscard]] Vec3f on_face() { return {0.13F, 0.29F, 0.5F}; }  // beside the edge

TEST_F(RobustShape, AFaceAloneIsAPlane) {
  add_face(edge(), Vec3f::UnitY());
  EXPECT_EQ(shaped_at(on_face()).shape, Shape::plane);
}

// A pillar's: from voxel to voxel both its faces are in each neighbourhood.
TEST_F(RobustShape, AFaceBesideAnEdgeIsAStripWithItsOwnNormal) {
  add_face(edge(), Vec3f::UnitY());
  add_face(edge(), Vec3f::UnitX());
  const Voxel& voxel = shaped_at(on_face());
  EXPECT_EQ(voxel.shape, Shape::strip);
  EXPECT_GT(std::abs(voxel.direction.x()), 0.99F);
}

TEST_F(RobustShape, OnlyUprightSurfacesAreStrips) {
  // A tread and its riser.
  add_face(edge(), Vec3f::UnitY(), Vec3f::UnitX());
  add_face(edge(), Vec3f::UnitZ(), Vec3f::UnitX());
  EXPECT_NE(shaped_at({0.5F, 0.29F, 0.02F}).shape, Shape::strip);
}

}  // namespace
}  // namespace convexcut::robust
