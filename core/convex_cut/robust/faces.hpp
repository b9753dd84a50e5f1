// SPDX-License-Identifier: Apache-2.0
//
// The face of a wall: where most of its cells lie. What hangs on a wall and fills one end of what
// is seen of it turns the plane that is fitted through both: by a centimetre or two at its ends, as
// much as the thing is thick, so that no step is left between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/convex_cut/robust/height_votes.hpp"
#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"

namespace convexcut::robust {

inline constexpr std::uint32_t kLargeFaceSurfels = 60;  // of a wall; smaller have no sure face

class Faces {
 public:
  Faces();

  // Turns large accepted walls, and the heights of their cells, so that most of these are equally
  // deep: square to the floor and to the other walls, or else each by itself. Glass stays.
  void lay(Model& model, PlaneGrids& grids) noexcept;

 private:
  // From the middle of its wall's cells, along the plane and upwards, and over it.
  struct FaceCell {
    float along_m, up_m, height_m;
  };
  struct Tilt {
    float along = 0.0F, up = 0.0F;  // slopes over the plane
  };
  struct Wall {
    std::size_t plane = 0;
    std::size_t first = 0, end = 0;                   // of its cells
    float middle_along_m = 0.0F, middle_up_m = 0.0F;  // from the frame's origin
    float half_along_m = 0.0F, half_up_m = 0.0F;
    Tilt to_square;  // to the largest wall, and to the floor
  };

  void take_walls(const Model& model, const PlaneGrids& grids) noexcept;
  [[nodiscard]] bool take_cells(const PlaneGrids& grids, Wall& wall) noexcept;
  [[nodiscard]] float common_heading() const noexcept;
  [[nodiscard]] Tilt tilt_of(const Wall& wall, float heading) const noexcept;
  [[nodiscard]] static float height_over(const FaceCell& cell, const Tilt& tilt) noexcept;
  [[nodiscard]] HeightVotes::Mode mode_of(const Wall& wall, const Tilt& tilt) const noexcept;
  [[nodiscard]] bool is_most_of(const Wall& wall, const Tilt& tilt) const noexcept;

  std::vector<FaceCell> cells_;
  std::vector<Wall> walls_;
};

}  // namespace convexcut::robust
