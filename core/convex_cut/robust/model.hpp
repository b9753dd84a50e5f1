// SPDX-License-Identifier: Apache-2.0
//
// What is known of the surroundings: small pieces of surface, the planes through them, and which of
// those bound the free space. One frame for all: z up, metres, the first revolution's lidar as
// origin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/convex_cut/robust/voxel_map.hpp"
#include "core/geometry.hpp"

namespace convexcut::robust {

inline constexpr std::int32_t kNoPlane = -1;

// A voxel of the window as a piece of surface; as many and in the same order as the map's voxels.
struct Surfel {
  Vec3f mean = Vec3f::Zero();
  Vec3f direction = Vec3f::Zero();  // see Shape
  Vec3f origin = Vec3f::Zero();     // where it was seen from
  std::int32_t points = 0;
  std::int32_t plane = kNoPlane;  // that it lies on
  float spread2 = 0.0F;           // m², of its points about that plane
  Shape shape = Shape::other;
  bool mirrored = false;   // an image behind a mirror, not a surface
  bool supported = false;  // by enough points to be a surface

  // Whether its ray tells of free space.
  [[nodiscard]] bool is_evidence() const noexcept { return supported && !mirrored; }
};

// normal · p + offset = 0; the normal points to the lidar.
struct Plane {
  Vec3f normal = Vec3f::UnitZ();
  float offset = 0.0F;
  std::uint32_t surfels = 0;
  float spread2 = 0.0F;   // m², of its points about it
  float face_m = 0.0F;    // where most of it lies, over itself
  bool edge_on = false;   // was mostly seen along itself: rings of the lidar, no surface
  bool vertical = false;  // a wall or the front of something; else a floor, a ceiling, a slope
  bool accepted = false;  // some of its cells are structure
  bool stepped = false;   // a board and the wall below it

  [[nodiscard]] float height_of(const Vec3f& p) const noexcept { return normal.dot(p) + offset; }
};

// Of a vertical plane: at a distance along it, where its axis `up` is 0.
[[nodiscard]] inline Vec3f point_of(const Plane& plane, float along_m) noexcept {
  return Vec3f::UnitZ().cross(plane.normal).normalized() * along_m - plane.normal * plane.offset;
}

// A run of columns of a vertical plane.
struct WallSegment {
  std::size_t plane = 0;
  std::int32_t first = 0, end = 0;      // columns of the plane's grid
  float begin_m = 0.0F, end_m = 0.0F;   // along the plane
  float bottom_m = 0.0F, top_m = 0.0F;  // z of what was seen of it
  std::uint32_t closed = 0, open = 0;   // cells seen in columns that nothing, something passes
  float spread2 = 0.0F;                 // m², of its points about the plane
  float steps = 0.0F;                   // share of neighbouring cells that are not equally deep
  bool accepted = false;
  bool narrow = false;                        // may be a pillar or a person
  bool free_begin = false, free_end = false;  // rays pass beside it
  bool furniture = false;                     // a wall is close behind, or it is a lamp

  [[nodiscard]] float width_m() const noexcept { return end_m - begin_m; }
  [[nodiscard]] float middle_m() const noexcept { return (begin_m + end_m) / 2; }
};

// What is narrower may be a pillar, a person or the side of furniture.
inline constexpr float kNarrowM = 0.8F;
inline constexpr float kTallerThanFurnitureM = 2.4F;  // over the floor
inline constexpr float kLowM = 1.0F;      // the same: sides of desks, seen between other things
inline constexpr float kFlatFace = 1.2F;  // spread², relative to the noise²: no thicker than it

// Where the lidar is, and how many revolutions the model is made of.
struct Sighting {
  Vec3f lidar = Vec3f::Zero();
  std::uint32_t revolutions = 1;
};

struct Model {
  std::vector<Surfel> surfels;
  std::vector<Plane> planes;
  std::vector<WallSegment> segments;  // plane by plane
  float noise2 = 4e-4F;               // m², of the sensor, as the largest planes show it
  float floor_z = -std::numeric_limits<float>::infinity();   // none known
  float ceiling_z = std::numeric_limits<float>::infinity();  // none known
};

}  // namespace convexcut::robust
