// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/parameters.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"

namespace convexcut::robust {

// Walls and the faces of pillars among the vertical planes. A column of a plane is open when
// something behind it is seen in the same column, above what stands there or below what hangs
// there, closed otherwise; where it is passed in the same cells that it is seen in, it is glass and
// closed. Walls are mostly closed; furniture is open wherever it does not reach
// the ceiling. Furniture whose top is out of view is told by the wall close behind it, which goes
// on beside or above it.
class Walls {
 public:
  Walls();

  // Fills model.segments and marks the cells of those that are accepted.
  void find(Model& model, PlaneGrids& grids, const Sighting& sighting,
            const RobustParameters& parameters) noexcept;

 private:
  struct Column {
    std::int32_t seen = 0;  // cells
    std::int32_t open = 0;  // cells that rays pass between floor and ceiling, and is not glass
    std::int32_t bottom = 0, top = -1;
    bool open_above = false;  // the highest of these is above the top
    bool is_gap = false;      // passed, also where it is seen: what is beyond is something else
  };
  void take_columns(const Model& model, const PlaneGrids& grids, std::size_t plane) noexcept;
  [[nodiscard]] static bool goes_up_to_ceiling(const Model& model, const PlaneGrids& grids,
                                               std::size_t plane, std::int32_t c,
                                               const Column& column) noexcept;
  void open_below_top(const Model& model, const PlaneGrids& grids, std::size_t plane,
                      std::int32_t first, std::int32_t end) noexcept;
  void split(Model& model, const PlaneGrids& grids, std::size_t plane, bool free_space) noexcept;
  void split_run(Model& model, const PlaneGrids& grids, std::size_t plane, std::int32_t first,
                 std::int32_t end) noexcept;
  void add_segment(Model& model, const PlaneGrids& grids, std::size_t plane, std::int32_t first,
                   std::int32_t end, bool accepted) noexcept;

  float lidar_z_ = 0.0F;
  std::vector<Column> columns_;  // of the plane at hand
  std::vector<float> tops_m_;    // of the segment at hand, by column
};

}  // namespace convexcut::robust
