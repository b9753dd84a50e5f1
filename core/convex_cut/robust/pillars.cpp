// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/pillars.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace convexcut::robust {
namespace {

constexpr std::int32_t kSide = 256;   // of the grid, columns
constexpr std::int32_t kLevels = 64;  // around the lidar's
constexpr std::size_t kMostColumns = 1U << 13U;
constexpr float kWallM = 1.2F;            // wide
constexpr int kLeastSeen = 4;             // voxels of a tall column
constexpr std::int32_t kLeastHeight = 5;  // levels
constexpr std::int32_t kMostWidth = 7;    // columns
constexpr float kLeastFilled = 0.4F;
constexpr float kFlat = 1.8F;  // thickness², relative to the noise²
constexpr float kWidestM = 1.3F;
constexpr float kThinnestM = 0.15F;  // less is one flat face: a board
constexpr float kThinnest = 0.25F;   // relative to the other side: an open door
constexpr float kCore = 0.4F;        // of the width: what passes there does not pass beside it
constexpr float kBehindM = 0.2F;
constexpr float kBesideM = 0.1F;
constexpr float kFreeM = 0.4F;
constexpr int kFewRays = 2;  // may be ghosts'

[[nodiscard]] constexpr std::size_t place_on_grid(std::int32_t x, std::int32_t y) noexcept {
  return static_cast<std::size_t>(y) * std::size_t{kSide} + static_cast<std::size_t>(x);
}

[[nodiscard]] std::int32_t height_of(std::uint64_t levels) noexcept {
  return static_cast<std::int32_t>(std::bit_width(levels)) - std::countr_zero(levels);
}

[[nodiscard]] bool is_tall(std::uint64_t levels) noexcept {
  return std::popcount(levels) >= kLeastSeen && height_of(levels) >= kLeastHeight;
}

// Of a surface that is spread evenly over it.
[[nodiscard]] float size_m(float variance_m2) noexcept { return std::sqrt(12.0F * variance_m2); }

}  // namespace

void Pillars::Spread::add(const Moments& points) noexcept {
  const auto m = [](std::int32_t mm) { return static_cast<float>(mm) * 1e-3F; };
  const auto m2 = [](std::int32_t mm2) { return static_cast<float>(mm2) * 1e-6F; };
  const float xy_m2 = m2(points.products_mm2[1]);
  weight += static_cast<float>(points.count);
  sum_m += Eigen::Vector2f(m(points.sum_mm[0]), m(points.sum_mm[1]));
  products_m2 +=
      Eigen::Matrix2f{{m2(points.products_mm2[0]), xy_m2}, {xy_m2, m2(points.products_mm2[3])}};
}

void Pillars::Spread::add(const Spread& other, float as_weight,
                          const Eigen::Vector2f& moved_m) noexcept {
  const Eigen::Vector2f mean = other.mean_m();
  const Eigen::Matrix2f mixed = mean * moved_m.transpose();
  weight += as_weight;
  sum_m += as_weight * (mean + moved_m);
  products_m2 += as_weight * (other.products_m2 / other.weight + mixed + mixed.transpose() +
                              moved_m * moved_m.transpose());
}

Eigen::Vector2f Pillars::Spread::variances_m2() const noexcept {
  const Eigen::Matrix2f c = products_m2 / weight - mean_m() * mean_m().transpose();
  const float half_sum = (c(0, 0) + c(1, 1)) / 2;
  const float half_difference = (c(0, 0) - c(1, 1)) / 2;
  const float root = std::sqrt(half_difference * half_difference + c(0, 1) * c(0, 1));
  return {std::max(half_sum - root, 0.0F), half_sum + root};
}

Pillars::Pillars(std::size_t max_surfels) {
  grid_.resize(std::size_t{kSide} * kSide);
  columns_.reserve(kMostColumns);
  members_.reserve(kMostColumns);
  column_of_surfel_.reserve(max_surfels);
  structure_.reserve(max_surfels);
}

std::span<const std::uint8_t> Pillars::find(const Model& model, const PlaneGrids& grids,
                                            const VoxelMap& map, const Vec3f& origin) noexcept {
  corner_ = place_of(origin);
  corner_[0] -= kSide / 2;
  corner_[1] -= kSide / 2;
  corner_[2] -= kLevels / 2;
  take_columns(model, grids, map);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].taken || !is_tall(columns_[i].levels)) continue;
    take_members(i);
    const Footprint footprint = footprint_of_members();
    if (footprint.width > kMostWidth || footprint.filled < kLeastFilled ||
        footprint.thickness2 > kFlat * model.noise2 ||
        footprint.shortest_m < std::max(kThinnestM, kThinnest * footprint.longest_m) ||
        footprint.longest_m > kWidestM || !stands_free(grids.rays(), footprint, origin)) {
      continue;
    }
    for (const std::uint16_t member : members_) columns_[member].pillar = true;
  }
  structure_.resize(column_of_surfel_.size());
  for (std::size_t i = 0; i < structure_.size(); ++i) {
    const std::uint16_t column = column_of_surfel_[i];
    structure_[i] = column != 0 && columns_[column - 1U].pillar ? 1 : 0;
  }
  return structure_;
}

void Pillars::take_columns(const Model& model, const PlaneGrids& grids,
                           const VoxelMap& map) noexcept {
  std::fill(grid_.begin(), grid_.end(), std::uint16_t{0});
  columns_.clear();
  std::uint64_t walls = 0;  // planes with a wide part
  for (const WallSegment& s : model.segments) {
    if (s.accepted && s.width_m() > kWallM) walls |= std::uint64_t{1} << s.plane;
  }
  column_of_surfel_.assign(model.surfels.size(), 0);
  for (std::size_t i = 0; i < model.surfels.size(); ++i) {
    const Surfel& surfel = model.surfels[i];
    if (surfel.mirrored) continue;
    bool wall = false;
    if (surfel.plane != kNoPlane) {
      const auto plane = static_cast<std::size_t>(surfel.plane);
      if (!model.planes[plane].vertical) continue;
      wall = (walls >> plane & 1U) != 0 && grids.is_on_structure(i);
    }
    column_of_surfel_[i] = add_voxel(map.voxels()[i], surfel.supported, wall);
  }
}

// The index of its column and 1, or 0.
std::uint16_t Pillars::add_voxel(const Voxel& voxel, bool supported, bool wall) noexcept {
  const Lattice place = place_of(voxel.key);
  const std::int32_t x = place[0] - corner_[0];
  const std::int32_t y = place[1] - corner_[1];
  const std::int32_t level = place[2] - corner_[2];
  // The grid's border has no neighbours.
  if (std::min({x, y, level}) < 1 || std::max(x, y) >= kSide - 1 || level >= kLevels) return 0;
  std::uint16_t& index = grid_[place_on_grid(x, y)];
  if (index == 0) {
    if (columns_.size() == kMostColumns) return 0;
    columns_.emplace_back();
    columns_.back().x = x;
    columns_.back().y = y;
    index = static_cast<std::uint16_t>(columns_.size());
  }
  Column& column = columns_[index - 1U];
  if (wall) {
    column.wall = true;
  } else if (supported) {
    column.levels |= std::uint64_t{1} << static_cast<std::uint32_t>(level);
    column.spread.add(voxel.moments);
  }
  return index;
}

void Pillars::take_members(std::size_t seed) noexcept {
  members_.assign(1, static_cast<std::uint16_t>(seed));
  columns_[seed].taken = true;
  at_wall_ = false;
  for (std::size_t next = 0; next < members_.size(); ++next) {
    const Column& from = columns_[members_[next]];
    for (std::int32_t y = from.y - 1; y <= from.y + 1; ++y) {
      for (std::int32_t x = from.x - 1; x <= from.x + 1; ++x) {
        const std::uint16_t index = grid_[place_on_grid(x, y)];
        if (index == 0) continue;
        Column& column = columns_[index - 1U];
        at_wall_ = at_wall_ || column.wall;
        if (column.taken || !is_tall(column.levels)) continue;
        column.taken = true;
        members_.push_back(static_cast<std::uint16_t>(index - 1U));
      }
    }
  }
}

Pillars::Footprint Pillars::footprint_of_members() const noexcept {
  Footprint footprint;
  std::uint64_t levels = 0;
  std::int32_t seen = 0;
  float points = 0.0F;
  Spread spread;
  const Column& first = columns_[members_.front()];
  std::array<std::int32_t, 2> low{first.x, first.y};
  std::array<std::int32_t, 2> high = low;
  for (const std::uint16_t member : members_) {
    const Column& column = columns_[member];
    low = {std::min(low[0], column.x), std::min(low[1], column.y)};
    high = {std::max(high[0], column.x), std::max(high[1], column.y)};
    levels |= column.levels;
    seen += std::popcount(column.levels);
    points += column.spread.weight;
    footprint.thickness2 += column.spread.weight * column.spread.variances_m2()[0];
    spread.add(column.spread, static_cast<float>(std::popcount(column.levels)),
               kVoxelM * Eigen::Vector2f(static_cast<float>(column.x - first.x),
                                         static_cast<float>(column.y - first.y)));
  }
  const Vec3f origin = centre_of({corner_[0] + first.x, corner_[1] + first.y, corner_[2]});
  footprint.mean_m = origin.head<2>() + spread.mean_m();
  footprint.width = std::max(high[0] - low[0], high[1] - low[1]) + 1;
  footprint.bottom = std::countr_zero(levels);
  footprint.height = height_of(levels);
  footprint.filled = static_cast<float>(seen) /
                     (static_cast<float>(members_.size()) * static_cast<float>(footprint.height));
  footprint.thickness2 /= points;
  footprint.shortest_m = size_m(spread.variances_m2()[0]);
  footprint.longest_m = size_m(spread.variances_m2()[1]);
  return footprint;
}

// By the rays that pass an upright plane through its middle, across the line of sight.
bool Pillars::stands_free(const Rays& rays, const Footprint& footprint,
                          const Vec3f& origin) noexcept {
  const float half_m = kVoxelM / 2 * static_cast<float>(footprint.width);
  const float bottom_m = kVoxelM * static_cast<float>(corner_[2] + footprint.bottom);
  const Vec3f middle(footprint.mean_m.x(), footprint.mean_m.y(), bottom_m);
  Vec3f sight = middle - origin;
  sight.z() = 0.0F;
  const float range_m = sight.norm();
  if (range_m < half_m + kBehindM) return false;
  Plane plane;
  plane.normal = -sight / range_m;
  plane.offset = -plane.normal.dot(middle);
  PlaneGrid grid;
  grid.along = Vec3f::UnitZ().cross(plane.normal);
  grid.up = Vec3f::UnitZ();
  const float at_m = grid.along.dot(middle);
  const auto cells = [](float m) { return static_cast<std::int32_t>(std::floor(m / kCellM)); };
  const float reach_m = half_m + kBesideM + kFreeM;
  grid.first_along = cells(at_m - reach_m);
  grid.columns = cells(at_m + reach_m) + 1 - grid.first_along;
  grid.first_up = cells(bottom_m) + 1;
  grid.rows = kLevels;
  const std::int32_t top = cells(kVoxelM * static_cast<float>(footprint.height));
  // A wall that a pillar is at may be closer behind its middle than its own sides are. A bookcase
  // is seen so too, but wall is seen over it, or the next one beside it.
  const float clear_m = half_m + kBehindM;
  int through = 0;
  std::array<bool, 2> free{};   // on its left, on its right
  std::array<bool, 2> clear{};  // and as far behind as nothing of the pillar is
  for (std::size_t begin = 0; begin < rays.size() && through <= kFewRays; begin += kRaysAtOnce) {
    find_passages(rays, begin, plane, grid, at_wall_ ? kBehindM : clear_m, kBehindM, passages_);
    for (std::size_t i = 0; i < passages_.count; ++i) {
      const float off_m = passages_.along_m[i] - at_m;
      const bool below_top = passages_.cell[i] < top * grid.columns;
      const bool is_clear = plane.height_of(rays.end(passages_.ray[i])) <= -clear_m;
      if (std::abs(off_m) < kCore * half_m) {
        through += is_clear || !below_top ? 1 : 0;
      } else if (std::abs(off_m) > half_m + kBesideM && below_top) {
        const std::size_t side = off_m < 0.0F ? 0 : 1;
        free[side] = true;
        clear[side] = clear[side] || is_clear;
      }
    }
  }
  return through <= kFewRays && ((free[0] && free[1]) || (at_wall_ && (clear[0] || clear[1])));
}

}  // namespace convexcut::robust
