// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/recesses.hpp"

#include <algorithm>
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

constexpr float kJambM = 0.25F;           // of an opening in an inner wall
constexpr float kLying = 0.7F;            // |z| of a normal: a table's, a sill's
constexpr std::int32_t kAround = 3;       // rows of cells above and below
constexpr std::int32_t kLeastOfThem = 2;  // cells of a column among these: jambs are higher

[[nodiscard]] bool is_lying(const Surfel& surfel) noexcept {
  return has_normal(surfel.shape) && std::abs(surfel.direction.z()) > kLying;
}

// Whether p is where a wall ends in its row, and rays go through its plane beside that.
[[nodiscard]] bool is_beside_opening(const PlaneGrids& grids, std::size_t wall,
                                     const Vec3f& p) noexcept {
  const PlaneGrid& grid = grids.grid(wall);
  const std::int32_t at_column = grid.column_of(p);
  const std::int32_t at_row = grid.row_of(p);
  const auto some_are = [&](std::int32_t column, const auto& test) {
    if (column < 0 || column >= grid.columns) return false;
    std::int32_t count = 0;
    const std::int32_t end = std::min(grid.rows, at_row + kAround + 1);
    for (std::int32_t row = std::max(0, at_row - kAround); row < end; ++row) {
      count += test(grids.cell(grid, column, row)) ? 1 : 0;
    }
    return count >= kLeastOfThem;
  };
  const auto is_wall = [](const Cell& cell) {
    return cell.structure && !cell.enclosed && cell.layer_m == 0.0F;
  };
  const auto is_hole = [](const Cell& cell) { return cell.is_hole(); };
  const auto ends = [&](std::int32_t side) {
    return some_are(at_column + side, is_hole) &&
           (some_are(at_column, is_wall) || some_are(at_column - side, is_wall));
  };
  return ends(-1) || ends(1);
}

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
  for (std::uint64_t walls = accepted; walls != 0 && count_ < kMost; walls &= walls - 1) {
    const auto wall = static_cast<std::size_t>(std::countr_zero(walls));
    if (!model.planes[wall].vertical) continue;
    recesses_.at(count_++) = {static_cast<std::uint8_t>(wall), kNothing};
  }
}

Recesses::Id Recesses::recess_of(const Model& model, const PlaneGrids& grids, const Surfel& surfel,
                                 float band_m) const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    const auto recess = static_cast<Id>(i);
    const auto [wall, behind] = recesses_.at(i);
    if (!holds(model, recess, surfel.mean, band_m) ||
        std::abs(surfel.direction.dot(model.planes[wall].normal)) >= kFacesTheRoom) {
      continue;
    }
    const bool is_side = behind == kNothing
                             ? !is_lying(surfel) && is_beside_opening(grids, wall, surfel.mean)
                             : grids.is_structure(wall, surfel.mean, kHalfAHole) &&
                                   grids.is_structure(behind, surfel.mean, kAtItsEdges);
    if (is_side) return recess;
  }
  return kNone;
}

bool Recesses::holds(const Model& model, Id recess, const Vec3f& p, float band_m) const noexcept {
  const auto [wall, behind] = recesses_.at(recess);
  const float height_m = model.planes[wall].height_of(p);
  if (height_m > band_m) return false;
  return behind == kNothing ? height_m >= -kJambM : model.planes[behind].height_of(p) >= -band_m;
}

}  // namespace convexcut::robust
