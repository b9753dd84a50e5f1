// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/recesses.hpp"

#include <bit>
#include <cmath>

#include "core/convex_cut/robust/point_kernels.hpp"

namespace convexcut::robust {
namespace {

constexpr float kParallel = 0.99F;       // cosine
constexpr float kShallowestM = 0.08F;    // less is a fixture, or within the band
constexpr float kDeepestM = 0.4F;        // of an outer wall
constexpr float kFacesTheRoom = 0.8F;    // cosine to the wall's normal: a blind, a thing on a sill
constexpr std::int32_t kHalfAHole = 5;   // cells, from its middle to the wall beside it
constexpr std::int32_t kAtItsEdges = 1;  // cells

}  // namespace

void Recesses::find(const Model& model) noexcept {
  count_ = 0;
  const std::uint64_t accepted = accepted_planes(model.planes);
  for (std::uint64_t walls = accepted; walls != 0; walls &= walls - 1) {
    const auto wall = static_cast<std::size_t>(std::countr_zero(walls));
    const Plane& front = model.planes[wall];
    if (!front.vertical) continue;
    for (std::uint64_t others = accepted; others != 0 && count_ < kMost; others &= others - 1) {
      const auto behind = static_cast<std::size_t>(std::countr_zero(others));
      const Plane& rear = model.planes[behind];
      const float depth_m = rear.offset - front.offset;
      if (!rear.vertical || rear.normal.dot(front.normal) < kParallel || depth_m < kShallowestM ||
          depth_m > kDeepestM) {
        continue;
      }
      recesses_.at(count_++) = {static_cast<std::uint8_t>(wall), static_cast<std::uint8_t>(behind)};
    }
  }
}

Recesses::Id Recesses::recess_of(const Model& model, const PlaneGrids& grids, const Surfel& surfel,
                                 float band_m) const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    const auto recess = static_cast<Id>(i);
    const auto [wall, behind] = recesses_.at(i);
    if (holds(model, recess, surfel.mean, band_m) &&
        std::abs(surfel.direction.dot(model.planes[wall].normal)) < kFacesTheRoom &&
        grids.is_structure(wall, surfel.mean, kHalfAHole) &&
        grids.is_structure(behind, surfel.mean, kAtItsEdges)) {
      return recess;
    }
  }
  return kNone;
}

bool Recesses::holds(const Model& model, Id recess, const Vec3f& p, float band_m) const noexcept {
  const auto [wall, behind] = recesses_.at(recess);
  return model.planes[wall].height_of(p) <= band_m && model.planes[behind].height_of(p) >= -band_m;
}

}  // namespace convexcut::robust
