// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/mirrors.hpp"

#include <algorithm>
#include <cmath>

#include "core/convex_cut/robust/ray_kernels.hpp"

namespace convexcut::robust {
namespace {

constexpr std::size_t kMostCells = 1U << 18U;
constexpr std::uint32_t kLargeSurfels = 40;  // of a wall
constexpr float kBehindM = 0.3F;
constexpr float kFarBehindM = 0.6F;  // nearer to the wall all is its own image
constexpr float kAlong = 0.5F;       // |cos| of a surface's normal to the wall's
constexpr float kSameM = 0.2F;
constexpr float kSameNormal = 0.85F;
constexpr float kPassedM = 0.1F;  // beside a place that a ray passes
constexpr float kGoesOnM = 0.3F;
constexpr std::size_t kMostAsked = 48;
constexpr std::size_t kMostReflected = 256;  // surfels of a hole: their share to 4 %
constexpr float kMostContradicted = 0.1F;    // of what has a counterpart
constexpr std::uint32_t kLeastInformative = 6;
constexpr float kLeastMatching = 0.4F;
constexpr float kLeastFrame = 0.35F;
constexpr std::int32_t kFrame = 2;  // cells

template <class Visit>
void for_each_around(const PlaneGrid& grid, std::uint32_t cell, std::int32_t reach,
                     Visit&& visit) noexcept {
  const auto columns = static_cast<std::uint32_t>(grid.columns);
  const auto column = static_cast<std::int32_t>(cell % columns);
  const auto row = static_cast<std::int32_t>(cell / columns);
  for (std::int32_t r = row - reach; r <= row + reach; ++r) {
    for (std::int32_t c = column - reach; c <= column + reach; ++c) {
      if (grid.holds(c, r))
        visit(static_cast<std::uint32_t>(r) * columns + static_cast<std::uint32_t>(c));
    }
  }
}

[[nodiscard]] Vec3f image_of(const Plane& plane, const Vec3f& place) noexcept {
  return place - 2.0F * plane.height_of(place) * plane.normal;
}

// Whether it is far enough behind the wall to tell an image. A surface across the wall is its own.
[[nodiscard]] bool is_informative(const Plane& plane, const Surfel& surfel) noexcept {
  const bool is_across =
      surfel.shape == Shape::plane && std::abs(plane.normal.dot(surfel.direction)) < kAlong;
  return plane.height_of(surfel.mean) <= -kFarBehindM && !is_across;
}

// Whether the surfel, reflected at the plane, lies on what is seen.
[[nodiscard]] bool has_counterpart(const Model& model, const VoxelMap& map, const Plane& plane,
                                   const Surfel& surfel) noexcept {
  const Vec3f image = image_of(plane, surfel.mean);
  const Vec3f direction =
      surfel.direction - 2.0F * plane.normal.dot(surfel.direction) * plane.normal;
  return any_neighbour(map, key_of(place_of(image)), [&](std::size_t k, const Lattice&) {
    const Surfel& other = model.surfels[k];
    return other.supported && (other.mean - image).norm() < kSameM &&
           (other.shape != Shape::plane || std::abs(other.direction.dot(direction)) > kSameNormal);
  });
}

// Whether a ray passes the place and goes on.
[[nodiscard]] bool is_seen_free(const Rays& rays, const Vec3f& place) noexcept {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec3f origin = rays.origin(i);
    const Vec3f way = rays.end(i) - origin;
    const Vec3f to_place = place - origin;
    const float length_m = way.norm();
    const float passed_m = to_place.dot(way) / length_m;
    const float beside2 = to_place.squaredNorm() - passed_m * passed_m;
    if (beside2 < kPassedM * kPassedM && passed_m > 0.0F && passed_m + kGoesOnM < length_m) {
      return true;
    }
  }
  return false;
}

}  // namespace

Mirrors::Mirrors(std::size_t max_surfels) {
  sights_.resize(max_surfels);
  unsorted_.reserve(max_surfels);
  starts_.reserve(kMostCells + 1);
  hole_.reserve(kMostCells);
  informative_.reserve(max_surfels);
  unmatched_.reserve(max_surfels);
  visited_.reserve(kMostCells);
}

bool Mirrors::find(Model& model, const PlaneGrids& grids, const VoxelMap& map) noexcept {
  bool any = false;
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    const Plane& plane = model.planes[k];
    if (!plane.accepted || !plane.vertical || plane.surfels < kLargeSurfels) continue;
    const PlaneGrid& grid = grids.grid(k);
    collect_sights(model, grids, k);
    visited_.assign(grid.cell_count(), 0);
    for (std::uint32_t cell = 0; cell < grid.cell_count(); ++cell) {
      if (starts_[cell] == starts_[cell + 1] || visited_[cell] != 0) continue;
      collect_hole(grid, cell);
      if (!is_image(model, map, plane) || !is_framed(grids, grid) ||
          is_contradicted(model, grids.rays(), map, plane)) {
        continue;
      }
      any = true;
      for (const std::uint32_t c : hole_) {
        for (std::uint32_t i = starts_[c]; i < starts_[c + 1]; ++i) {
          model.surfels[sights_[i].surfel].mirrored = true;
        }
      }
    }
  }
  return any;
}

void Mirrors::collect_sights(const Model& model, const PlaneGrids& grids,
                             std::size_t plane) noexcept {
  const PlaneGrid& grid = grids.grid(plane);
  unsorted_.clear();
  starts_.assign(grid.cell_count() + 1, 0);
  const Rays& rays = grids.rays();
  Passages passages;
  for (std::size_t begin = 0; begin < rays.size(); begin += kRaysAtOnce) {
    find_passages(rays, begin, model.planes[plane], grid, kBehindM, kInFrontM, passages);
    for (std::size_t i = 0; i < passages.count; ++i) {
      const std::uint32_t surfel = rays.surfel(passages.ray[i]);
      if (model.surfels[surfel].mirrored) continue;
      const auto cell = static_cast<std::uint32_t>(passages.cell[i]);
      unsorted_.push_back({cell, surfel});
      ++starts_[cell + 1];
    }
  }
  for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
  // Each cell's start serves as its next free place, and is its end when all are placed.
  for (const Sight& sight : unsorted_) sights_[starts_[sight.cell]++] = sight;
  for (std::size_t c = starts_.size() - 1; c > 0; --c) starts_[c] = starts_[c - 1];
  starts_[0] = 0;
}

void Mirrors::collect_hole(const PlaneGrid& grid, std::uint32_t seed) noexcept {
  hole_.clear();
  hole_.push_back(seed);
  visited_[seed] = 1;
  for (std::size_t next = 0; next < hole_.size(); ++next) {
    for_each_around(grid, hole_[next], 1, [&](std::uint32_t cell) {
      if (visited_[cell] != 0 || starts_[cell] == starts_[cell + 1]) return;
      visited_[cell] = 1;
      hole_.push_back(cell);
    });
  }
}

// Whether wall is seen around the hole.
bool Mirrors::is_framed(const PlaneGrids& grids, const PlaneGrid& grid) noexcept {
  constexpr std::uint8_t kInFrame = 2;
  const auto columns = static_cast<std::uint32_t>(grid.columns);
  std::uint32_t frame = 0;
  std::uint32_t wall = 0;
  for (const std::uint32_t in_hole : hole_) {
    for_each_around(grid, in_hole, kFrame, [&](std::uint32_t cell) {
      if (starts_[cell] != starts_[cell + 1] || (visited_[cell] & kInFrame) != 0) return;
      visited_[cell] = static_cast<std::uint8_t>(visited_[cell] | kInFrame);
      ++frame;
      wall += grids.cell(grid, static_cast<std::int32_t>(cell % columns),
                         static_cast<std::int32_t>(cell / columns))
                          .seen > 0
                  ? 1U
                  : 0U;
    });
  }
  return static_cast<float>(wall) > kLeastFrame * static_cast<float>(frame);
}

bool Mirrors::is_image(const Model& model, const VoxelMap& map, const Plane& plane) noexcept {
  informative_.clear();
  for (const std::uint32_t cell : hole_) {
    for (std::uint32_t i = starts_[cell]; i < starts_[cell + 1]; ++i) {
      const Surfel& surfel = model.surfels[sights_[i].surfel];
      if (surfel.shape == Shape::plane && is_informative(plane, surfel)) {
        informative_.push_back(sights_[i].surfel);
      }
    }
  }
  if (informative_.size() < kLeastInformative) return false;
  const std::size_t step = (informative_.size() - 1) / kMostReflected + 1;
  const std::size_t asked = (informative_.size() - 1) / step + 1;
  const float least = kLeastMatching * static_cast<float>(asked);
  std::size_t matching = 0;
  for (std::size_t i = 0; i < asked; ++i) {
    const std::size_t most = matching + asked - i;
    if (static_cast<float>(most) <= least) return false;
    matching += has_counterpart(model, map, plane, model.surfels[informative_[i * step]]) ? 1U : 0U;
    if (static_cast<float>(matching) > least) return true;
  }
  return false;
}

// What an image shows is where its counterpart is: not much of it in space that is seen to be free.
bool Mirrors::is_contradicted(const Model& model, const Rays& rays, const VoxelMap& map,
                              const Plane& plane) noexcept {
  unmatched_.clear();
  std::size_t matching = 0;
  for (const std::uint32_t cell : hole_) {
    for (std::uint32_t i = starts_[cell]; i < starts_[cell + 1]; ++i) {
      const Surfel& surfel = model.surfels[sights_[i].surfel];
      if (!is_informative(plane, surfel)) continue;
      if (has_counterpart(model, map, plane, surfel)) {
        ++matching;
      } else {
        unmatched_.push_back(sights_[i].surfel);
      }
    }
  }
  const std::size_t step = unmatched_.size() / kMostAsked + 1;
  std::size_t asked = 0;
  std::size_t free = 0;
  for (std::size_t i = 0; i < unmatched_.size(); i += step) {
    ++asked;
    free += is_seen_free(rays, image_of(plane, model.surfels[unmatched_[i]].mean)) ? 1U : 0U;
  }
  if (asked == 0) return false;
  const float contradicting =
      static_cast<float>(free * unmatched_.size()) / static_cast<float>(asked);
  return contradicting > kMostContradicted * static_cast<float>(matching);
}

}  // namespace convexcut::robust
