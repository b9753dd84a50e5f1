// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/convex_cut/robust/cell_set.hpp"
#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"

namespace convexcut::robust {

// Floors, ceilings and slopes: of the planes that are not vertical, the connected parts around
// which nothing is seen behind. A table's top is passed by rays to the floor on all sides; where
// these are hidden, it is told by the floor that goes on around it, in one part or several, or by
// other tables of its height.
class FlatSurfaces {
 public:
  FlatSurfaces();

  // Marks their cells, and finds the model's floor and ceiling. free_space: as in
  // RobustParameters.
  void find(Model& model, PlaneGrids& grids, const Vec3f& origin, bool free_space) noexcept;

 private:
  struct Place {
    std::int32_t column, row;
  };
  // Connected cells that bound the free space.
  struct Part {
    std::size_t plane = 0;
    std::int16_t id = 0;
    std::size_t cells = 0;
    Vec3f low, high;  // of its cells' centres
    bool of_a_table = false;

    void take_in(const Part& other) noexcept;
  };
  void take_unclaimed(const PlaneGrids& grids, const PlaneGrid& grid) noexcept;
  void add_part(const Plane& plane, std::size_t k, const PlaneGrid& grid, std::int16_t id,
                std::vector<Part>& parts) noexcept;
  [[nodiscard]] std::optional<Part> whole_floor(const Model& model,
                                                const Vec3f& origin) const noexcept;
  [[nodiscard]] static bool is_above_floor(const Model& model, const Part& part,
                                           const Part& floor) noexcept;
  [[nodiscard]] bool is_of_table_tops(const Model& model, const Part& part,
                                      const Part& floor) const noexcept;
  void reject_table_tops(const Model& model, const Vec3f& origin) noexcept;
  void reject_undersides(const Model& model) noexcept;
  static void accept(Model& model, PlaneGrids& grids, const Part& part) noexcept;
  [[nodiscard]] static bool is_in_line(const Part& a, const Part& b) noexcept;
  [[nodiscard]] static bool is_beam(const Part& part) noexcept;
  void add_beams(const Model& model) noexcept;
  static void find_levels(Model& model, const Vec3f& origin) noexcept;
  void collect_part(PlaneGrids& grids, const PlaneGrid& grid, Place seed, std::int16_t id) noexcept;
  [[nodiscard]] bool bounds_free_space(const PlaneGrids& grids, const PlaneGrid& grid) noexcept;

  std::vector<Place> part_;  // also the queue of the search for it
  std::vector<Place> ring_;
  CellSet unclaimed_;  // cells of the plane that were seen and are in no part yet
  CellSet outside_;    // cells that are neither in the part at hand nor in its ring
  std::vector<Part> parts_;
  std::vector<Part> open_parts_;  // that are passed around
  std::vector<Part> undersides_;  // that are not, and are too small for a ceiling
};

}  // namespace convexcut::robust
