// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/convex_cut/robust/faces.hpp"
#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"

namespace convexcut::robust {

// Of a wall: where most of it lies, over its plane.
struct WallFace {
  float height_m = 0.0F;
  float proud_m = 0.0F;  // a cell that is so far before it is none of it

  [[nodiscard]] bool holds(float cell_m) const noexcept {
    return cell_m <= height_m + proud_m && cell_m >= height_m - kBehindM;
  }

 private:
  static constexpr float kBehindM = 0.017F;  // where a wall ends, cells hold its jambs too
};

// What lies flat on a wall or in a recess of it, nearer than a band can tell: pictures, boards,
// blinds, the backs of bookcases. The mean of a cell's points is known to millimetres, so connected
// cells that are off the wall's face together show a layer. What of it stands on the floor like a
// door, or is as high as the room, is a part of the wall; a board beside it may be none.
class Fixtures {
 public:
  Fixtures();

  // Sets the faces of the accepted vertical planes and the layers of their cells.
  void find(Model& model, PlaneGrids& grids) noexcept;

 private:
  struct Place {
    std::int32_t column, row;
  };
  enum class Upright : std::uint8_t { none, door, wall };
  [[nodiscard]] Upright upright_of(const Model& model, const PlaneGrids& grids, std::size_t plane,
                                   const WallFace& face, std::size_t first,
                                   std::size_t end) const noexcept;
  void collect_layer(PlaneGrids& grids, const PlaneGrid& grid, const WallFace& face,
                     Place seed) noexcept;
  [[nodiscard]] bool is_in_front(const PlaneGrids& grids, const PlaneGrid& grid) const noexcept;
  [[nodiscard]] bool is_glass(const PlaneGrids& grids, const PlaneGrid& grid) const noexcept;
  [[nodiscard]] bool is_in_a_recess(const PlaneGrids& grids, const PlaneGrid& grid,
                                    const WallFace& face) const noexcept;
  [[nodiscard]] std::optional<float> wall_behind(const Model& model, PlaneGrids& grids,
                                                 std::size_t plane, const WallFace& face) noexcept;
  [[nodiscard]] bool goes_on_below(const Model& model, const PlaneGrids& grids, std::size_t plane,
                                   const WallFace& face) const noexcept;
  void leave_out_doors(const Model& model, PlaneGrids& grids, std::size_t plane,
                       const WallFace& face) noexcept;

  Faces faces_;
  std::vector<Place> layer_;  // also the queue of the search for it
};

}  // namespace convexcut::robust
