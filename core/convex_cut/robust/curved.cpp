// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/curved.hpp"

#include <algorithm>
#include <cmath>

namespace convexcut::robust {
namespace {

constexpr float kUpright = 0.5F;  // |z| of a wall's normal at most
constexpr float kSmooth = 0.93F;  // cosine between neighbours
constexpr float kStepM = 0.05F;

enum State : std::uint8_t { kOpenState, kReached, kRefused };

// Of a plane that was rejected only because it is narrow.
[[nodiscard]] bool is_on_narrow(const Model& model, const PlaneGrids& grids,
                                const Surfel& surfel) noexcept {
  const auto plane = static_cast<std::size_t>(surfel.plane);
  if (!model.planes[plane].vertical) return false;
  const std::int32_t column = grids.grid(plane).column_of(surfel.mean);
  return std::any_of(model.segments.begin(), model.segments.end(), [&](const WallSegment& s) {
    return s.plane == plane && column >= s.first && column < s.end && s.narrow && !s.accepted &&
           !s.furniture;
  });
}

// Smoothly, from one voxel to the next.
[[nodiscard]] bool goes_on(const Surfel& from, const Surfel& to) noexcept {
  const Vec3f step = to.mean - from.mean;
  return std::abs(from.direction.dot(to.direction)) >= kSmooth &&
         std::abs(from.direction.dot(step)) <= kStepM && std::abs(to.direction.dot(step)) <= kStepM;
}

}  // namespace

Curved::Curved(std::size_t max_surfels) {
  queue_.reserve(max_surfels);
  state_.reserve(max_surfels);
  structure_.reserve(max_surfels);
}

std::span<const std::uint8_t> Curved::find(const Model& model, const PlaneGrids& grids,
                                           const VoxelMap& map) noexcept {
  structure_.assign(model.surfels.size(), 0);
  take_seeds(model, grids);
  grow(model, map);
  return structure_;
}

void Curved::take_seeds(const Model& model, const PlaneGrids& grids) noexcept {
  state_.assign(model.surfels.size(), kOpenState);
  for (std::size_t i = 0; i < model.surfels.size(); ++i) {
    const Surfel& surfel = model.surfels[i];
    if (surfel.mirrored || surfel.shape != Shape::plane ||
        std::abs(surfel.direction.z()) > kUpright) {
      state_[i] = kRefused;
      continue;
    }
    const bool on_wall = surfel.plane != kNoPlane && grids.is_on_structure(i);
    if (on_wall) {
      state_[i] = kReached;
    } else if (surfel.plane != kNoPlane && !is_on_narrow(model, grids, surfel)) {
      state_[i] = kRefused;
    }
  }
}

// First what goes on from a wall, then what goes on from that: there are far more surfels on walls
// than there are open ones.
void Curved::grow(const Model& model, const VoxelMap& map) noexcept {
  queue_.clear();
  const auto reach = [&](std::size_t i) {
    state_[i] = kReached;
    structure_[i] = 1;
    queue_.push_back(static_cast<std::uint32_t>(i));
  };
  for (std::size_t i = 0; i < model.surfels.size(); ++i) {
    if (state_[i] != kOpenState) continue;
    if (any_neighbour(map, map.voxels()[i].key, [&](std::size_t k, const Lattice&) {
          return state_[k] == kReached && goes_on(model.surfels[i], model.surfels[k]);
        })) {
      reach(i);
    }
  }
  // NOLINTNEXTLINE(modernize-loop-convert): the queue grows meanwhile.
  for (std::size_t next = 0; next < queue_.size(); ++next) {
    const std::uint32_t i = queue_[next];
    for_each_neighbour(map, map.voxels()[i].key, [&](std::size_t k, const Lattice&) {
      if (state_[k] == kOpenState && goes_on(model.surfels[i], model.surfels[k])) reach(k);
    });
  }
}

}  // namespace convexcut::robust
