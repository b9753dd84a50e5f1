// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/curved.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace convexcut::robust {
namespace {

constexpr float kSquareM = 0.25F;
constexpr float kSameOriginM = 0.5F;
constexpr float kFarthestM = 0.3F;    // nearer than this to the farthest counts as farthest
constexpr float kNearPlaneM = 0.12F;  // is left to the plane
constexpr float kAboveFloorM = 0.1F;
constexpr float kBelowCeilingM = 0.05F;
constexpr float kToCeilingM = 0.4F;
constexpr float kLeastHeightM = 1.0F;
constexpr float kUpright = 0.5F;  // |z| of a wall's normal at most
constexpr float kSmooth = 0.93F;  // cosine between neighbours
constexpr float kStepM = 0.05F;

enum State : std::uint8_t { kOpenState, kReached, kRefused };

[[nodiscard]] float distance(const Vec3f& p, const Vec3f& origin) noexcept {
  return (p - origin).head<2>().norm();
}

[[nodiscard]] std::size_t sector_of(const Vec3f& p, const Vec3f& origin, std::size_t count) {
  constexpr float kPi = std::numbers::pi_v<float>;
  const float turn = (std::atan2(p.y() - origin.y(), p.x() - origin.x()) + kPi) / (2.0F * kPi);
  return std::min(static_cast<std::size_t>(turn * static_cast<float>(count)), count - 1);
}

constexpr std::uint64_t kBias = 1U << 20U;
[[nodiscard]] std::uint64_t square_at(std::int64_t x, std::int64_t y) noexcept {
  return ((static_cast<std::uint64_t>(x) + kBias) << 32U) | (static_cast<std::uint64_t>(y) + kBias);
}
[[nodiscard]] std::uint64_t square_of(const Vec3f& p) noexcept {
  return square_at(static_cast<std::int64_t>(std::floor(p.x() / kSquareM)),
                   static_cast<std::int64_t>(std::floor(p.y() / kSquareM)));
}

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

[[nodiscard]] bool is_near_structure(const Model& model, const PlaneGrids& grids,
                                     const Vec3f& p) noexcept {
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    const Plane& plane = model.planes[k];
    if (plane.accepted && std::abs(plane.height_of(p)) < kNearPlaneM &&
        grids.is_structure(k, p, 1)) {
      return true;
    }
  }
  return false;
}

}  // namespace

Curved::Curved(std::size_t max_surfels) {
  candidates_.reserve(max_surfels);
  group_.reserve(max_surfels);
  queue_.reserve(max_surfels);
  state_.reserve(max_surfels);
  structure_.reserve(max_surfels);
}

std::span<const std::uint8_t> Curved::find(const Model& model, const PlaneGrids& grids,
                                           const VoxelMap& map, const Vec3f& origin) noexcept {
  structure_.assign(model.surfels.size(), 0);
  measure_sectors(model, origin);
  collect_candidates(model, grids, origin);
  for (std::size_t seed = 0; seed < candidates_.size(); ++seed) {
    if (candidates_[seed].visited) continue;
    collect_group(seed);
    if (!is_structure(model)) continue;
    for (const std::uint32_t c : group_) structure_[candidates_[c].surfel] = 1;
  }
  grow(model, grids, map);
  return structure_;
}

void Curved::measure_sectors(const Model& model, const Vec3f& origin) noexcept {
  farthest_m_.fill(0.0F);
  for (const Surfel& surfel : model.surfels) {
    if (!surfel.is_evidence() || (surfel.origin - origin).norm() > kSameOriginM) continue;
    float& farthest = farthest_m_[sector_of(surfel.mean, origin, kSectors)];
    farthest = std::max(farthest, distance(surfel.mean, origin));
  }
}

void Curved::collect_candidates(const Model& model, const PlaneGrids& grids,
                                const Vec3f& origin) noexcept {
  candidates_.clear();
  for (std::size_t i = 0; i < model.surfels.size(); ++i) {
    const Surfel& surfel = model.surfels[i];
    if (!surfel.is_evidence()) continue;
    const Vec3f& p = surfel.mean;
    if (p.z() < model.floor_z + kAboveFloorM || p.z() > model.ceiling_z - kBelowCeilingM) continue;
    if (distance(p, origin) < farthest_m_[sector_of(p, origin, kSectors)] - kFarthestM) continue;
    if (surfel.plane != kNoPlane && !is_on_narrow(model, grids, surfel)) continue;
    if (is_near_structure(model, grids, p)) continue;
    candidates_.push_back({square_of(p), static_cast<std::uint32_t>(i), false});
  }
  std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
    return a.place != b.place ? a.place < b.place : a.surfel < b.surfel;
  });
}

void Curved::collect_group(std::size_t seed) noexcept {
  group_.clear();
  group_.push_back(static_cast<std::uint32_t>(seed));
  candidates_[seed].visited = true;
  for (std::size_t next = 0; next < group_.size(); ++next) {
    const std::uint64_t place = candidates_[group_[next]].place;
    const auto x = static_cast<std::int64_t>(place >> 32U) - static_cast<std::int64_t>(kBias);
    const auto y =
        static_cast<std::int64_t>(place & 0xFFFFFFFFU) - static_cast<std::int64_t>(kBias);
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) visit_place(square_at(x + dx, y + dy));
    }
  }
}

void Curved::visit_place(std::uint64_t place) noexcept {
  auto at = std::lower_bound(candidates_.begin(), candidates_.end(), place,
                             [](const Candidate& c, std::uint64_t p) { return c.place < p; });
  for (; at != candidates_.end() && at->place == place; ++at) {
    if (at->visited) continue;
    at->visited = true;
    group_.push_back(static_cast<std::uint32_t>(at - candidates_.begin()));
  }
}

bool Curved::is_structure(const Model& model) const noexcept {
  Vec3f low = Vec3f::Constant(1e9F);
  Vec3f high = -low;
  for (const std::uint32_t c : group_) {
    const Vec3f& p = model.surfels[candidates_[c].surfel].mean;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  if (high.z() - low.z() < kLeastHeightM) return false;
  return high.z() > model.ceiling_z - kToCeilingM;
}

void Curved::grow(const Model& model, const PlaneGrids& grids, const VoxelMap& map) noexcept {
  state_.assign(model.surfels.size(), kOpenState);
  queue_.clear();
  for (std::size_t i = 0; i < model.surfels.size(); ++i) {
    const Surfel& surfel = model.surfels[i];
    if (surfel.mirrored || surfel.shape != Shape::plane ||
        std::abs(surfel.direction.z()) > kUpright) {
      state_[i] = kRefused;
      continue;
    }
    const bool on_wall = surfel.plane != kNoPlane &&
                         grids.is_structure(static_cast<std::size_t>(surfel.plane), surfel.mean, 0);
    if (on_wall || structure_[i] != 0) {
      state_[i] = kReached;
      queue_.push_back(static_cast<std::uint32_t>(i));
    } else if (surfel.plane != kNoPlane && !is_on_narrow(model, grids, surfel)) {
      state_[i] = kRefused;
    }
  }
  for (std::size_t next = 0; next < queue_.size(); ++next) {
    const std::uint32_t i = queue_[next];
    const Surfel& from = model.surfels[i];
    for_each_neighbour(map, map.voxels()[i].key, [&](std::size_t k, const Lattice&) {
      if (state_[k] != kOpenState) return;
      const Surfel& to = model.surfels[k];
      const Vec3f step = to.mean - from.mean;
      if (std::abs(from.direction.dot(to.direction)) < kSmooth ||
          std::abs(from.direction.dot(step)) > kStepM ||
          std::abs(to.direction.dot(step)) > kStepM) {
        return;
      }
      state_[k] = kReached;
      structure_[k] = 1;
      queue_.push_back(static_cast<std::uint32_t>(k));
    });
  }
}

}  // namespace convexcut::robust
