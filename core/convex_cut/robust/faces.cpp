// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/faces.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/convex_cut/robust/plane_search.hpp"

namespace convexcut::robust {
namespace {

constexpr std::size_t kMostFaceCells = 1U << 14U;

// What can be told from cells: a wall of some size.
constexpr std::size_t kLeastCells = 8;
constexpr float kLeastWidthM = 1.0F;
constexpr float kLeastHeightM = 0.5F;
constexpr float kGlass = 0.05F;  // share of its cells that rays pass

// Of a wall by itself: at its ends, and at its top and foot.
constexpr float kStepM = 0.005F;
constexpr int kAlongSteps = 7;
constexpr int kUpSteps = 2;
constexpr float kBetter = 1.15F;  // times the cells that agree on the face as it was fitted

constexpr float kOnFaceM = 0.012F;  // of a cell's mean; a thinner thing is not told from its wall
constexpr float kMost = 0.55F;      // share of the cells that a face has

// Of a wall among others: rooms are built square, so fewer cells suffice.
constexpr float kSquare = 1.3F;  // times its cells count
constexpr float kMostTurn = 0.02F;
constexpr float kMostTurnedM = 0.06F;  // at its ends
constexpr float kMostLeaningM = 0.04F;
constexpr float kTurnStep = 0.001F;
constexpr int kTurns = 20;

constexpr float kUpright = 0.1F;  // sine
constexpr float kQuarter = std::numbers::pi_v<float> / 2;

[[nodiscard]] float heading_of(const Plane& plane) noexcept {
  return std::atan2(plane.normal.y(), plane.normal.x());
}

[[nodiscard]] const Plane* largest_wall(const Model& model) noexcept {
  const Plane* largest = nullptr;
  for (const Plane& plane : model.planes) {
    if (!plane.accepted || !plane.vertical || std::abs(plane.normal.z()) > kUpright) continue;
    if (largest == nullptr || plane.surfels > largest->surfels) largest = &plane;
  }
  return largest;
}

}  // namespace

Faces::Faces() {
  cells_.reserve(kMostFaceCells);
  walls_.reserve(PlaneSearch::kMostPlanes);
}

void Faces::lay(Model& model, PlaneGrids& grids) noexcept {
  take_walls(model, grids);
  const float heading = common_heading();
  for (const Wall& wall : walls_) {
    const Tilt tilt = tilt_of(wall, heading);
    if (tilt.along == 0.0F && tilt.up == 0.0F) continue;
    Plane& plane = model.planes[wall.plane];
    const PlaneGrid& grid = grids.grid(wall.plane);
    const Vec3f middle =
        grid.along * wall.middle_along_m + grid.up * wall.middle_up_m - plane.normal * plane.offset;
    grids.turn(plane, grid, middle, tilt.along, tilt.up);
  }
}

void Faces::take_walls(const Model& model, const PlaneGrids& grids) noexcept {
  cells_.clear();
  walls_.clear();
  const Plane* largest = largest_wall(model);
  if (largest == nullptr) return;
  const Vec3f up = up_of(model);
  for (std::size_t k = 0; k < model.planes.size(); ++k) {
    const Plane& plane = model.planes[k];
    if (!plane.accepted || !plane.vertical || plane.stepped) continue;
    if (plane.surfels < kLargeFaceSurfels) continue;
    Wall wall;
    wall.plane = k;
    wall.first = cells_.size();
    if (!take_cells(grids, wall)) {
      cells_.resize(wall.first);
      continue;
    }
    wall.to_square.along = -std::remainder(heading_of(*largest) - heading_of(plane), kQuarter);
    wall.to_square.up = plane.normal.dot(up);
    walls_.push_back(wall);
  }
}

// False where they do not tell of a face.
bool Faces::take_cells(const PlaneGrids& grids, Wall& wall) noexcept {
  const PlaneGrid& grid = grids.grid(wall.plane);
  std::size_t glass = 0;
  Extent along;
  Extent up;
  const auto add = [](Extent& extent, float at_m) {
    extent.low_m = std::min(extent.low_m, at_m);
    extent.high_m = std::max(extent.high_m, at_m);
  };
  for (std::int32_t column = 0; column < grid.columns; ++column) {
    for (std::int32_t row = 0; row < grid.rows; ++row) {
      const Cell& cell = grids.cell(grid, column, row);
      if (cell.is_hole()) break;
      if (!cell.structure || cell.enclosed || !cell.tells_depth()) continue;
      if (cell.passed > 0) ++glass;
      if (cell.passed > 0 || cells_.size() == kMostFaceCells) continue;
      const float along_m = (static_cast<float>(grid.first_along + column) + 0.5F) * kCellM;
      const float up_m = (static_cast<float>(grid.first_up + row) + 0.5F) * kCellM;
      add(along, along_m);
      add(up, up_m);
      cells_.push_back({along_m, up_m, cell.mean_m()});
    }
  }
  wall.end = cells_.size();
  const std::size_t count = wall.end - wall.first;
  if (count < kLeastCells ||
      static_cast<float>(glass) > kGlass * static_cast<float>(count + glass) ||
      along.high_m - along.low_m < kLeastWidthM || up.high_m - up.low_m < kLeastHeightM) {
    return false;
  }
  wall.middle_along_m = (along.low_m + along.high_m) / 2;
  wall.middle_up_m = (up.low_m + up.high_m) / 2;
  wall.half_along_m = (along.high_m - along.low_m) / 2;
  wall.half_up_m = (up.high_m - up.low_m) / 2;
  for (std::size_t i = wall.first; i < wall.end; ++i) {
    cells_[i].along_m -= wall.middle_along_m;
    cells_[i].up_m -= wall.middle_up_m;
  }
  return true;
}

// Against the largest wall: the one that most cells of all nearly square walls agree on, the
// smallest of those.
float Faces::common_heading() const noexcept {
  float heading = 0.0F;
  std::int32_t most = -1;
  for (int i = 0; i <= 2 * kTurns; ++i) {
    const float turned = static_cast<float>(i % 2 != 0 ? (i + 1) / 2 : -i / 2) * kTurnStep;
    std::int32_t votes = 0;
    for (const Wall& wall : walls_) {
      if (std::abs(wall.to_square.along) > kMostTurn || std::abs(wall.to_square.up) > kMostTurn) {
        continue;
      }
      votes += mode_of(wall, {wall.to_square.along - turned, wall.to_square.up}).votes;
    }
    if (votes <= most) continue;
    most = votes;
    heading = turned;
  }
  return heading;
}

// The one that most cells agree on; none where it is hardly better.
Faces::Tilt Faces::tilt_of(const Wall& wall, float heading) const noexcept {
  Tilt best;
  float most = kBetter * static_cast<float>(mode_of(wall, best).votes);
  const Tilt square{wall.to_square.along - heading, wall.to_square.up};
  if (std::abs(square.along) < kMostTurn && std::abs(square.up) < kMostTurn &&
      std::abs(square.along) * wall.half_along_m < kMostTurnedM &&
      std::abs(square.up) * wall.half_up_m < kMostLeaningM) {
    const float votes = kSquare * static_cast<float>(mode_of(wall, square).votes);
    if (votes >= most) {
      most = votes;
      best = square;
    }
  }
  for (int a = -kAlongSteps; a <= kAlongSteps; ++a) {
    for (int u = -kUpSteps; u <= kUpSteps; ++u) {
      const Tilt tilt{static_cast<float>(a) * kStepM / wall.half_along_m,
                      static_cast<float>(u) * kStepM / wall.half_up_m};
      const auto votes = static_cast<float>(mode_of(wall, tilt).votes);
      if (votes <= most) continue;
      most = votes;
      best = tilt;
    }
  }
  return is_most_of(wall, best) ? best : Tilt{};
}

// Two halves of a wall with a step between them are no wall with a thing on it.
bool Faces::is_most_of(const Wall& wall, const Tilt& tilt) const noexcept {
  const float face_m = mode_of(wall, tilt).height_m;
  std::size_t on_face = 0;
  for (std::size_t i = wall.first; i < wall.end; ++i) {
    on_face += std::abs(height_over(cells_[i], tilt) - face_m) <= kOnFaceM ? 1U : 0U;
  }
  return static_cast<float>(on_face) > kMost * static_cast<float>(wall.end - wall.first);
}

float Faces::height_over(const FaceCell& cell, const Tilt& tilt) noexcept {
  return cell.height_m - tilt.along * cell.along_m - tilt.up * cell.up_m;
}

// Of the heights over the tilted plane.
HeightVotes::Mode Faces::mode_of(const Wall& wall, const Tilt& tilt) const noexcept {
  HeightVotes votes;
  for (std::size_t i = wall.first; i < wall.end; ++i) votes.add(height_over(cells_[i], tilt));
  return votes.mode();
}

}  // namespace convexcut::robust
