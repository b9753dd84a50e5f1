// SPDX-License-Identifier: Apache-2.0
//
// A beam is wider than a ray: at the edges of things it meets more than one of them.
#pragma once

#include <array>
#include <cstddef>

#include "core/angle.hpp"
#include "replay/simulation/lidar/column.hpp"
#include "replay/simulation/lidar/echoes.hpp"

namespace convexcut::simulation {

// The columns of the firing before, of the own one and of the next one.
struct Neighbourhood {
  const Column& before;
  const Column& own;
  const Column& next;
};

// Of a laser's beam: where its rim may meet another plane than its middle. Bit i is side i.
using Sides = unsigned;

class Beam {
 public:
  explicit Beam(Radians divergence);

  // Below and above, of each laser of a column: where the neighbouring ring met another plane, and
  // the rim towards it does so too.
  using UprightSides = std::array<Sides, Column::kLasers>;
  [[nodiscard]] UprightSides upright_sides(const Column& column) const noexcept;

  // Where the firings before and after did not meet the plane that the laser met itself. None here,
  // and none of the upright ones: the middle ray stands for all of the beam.
  [[nodiscard]] Sides level_sides(const Neighbourhood& around, std::size_t laser) const noexcept;

  // Adds the echoes of the laser's beam. The rim towards the sides is asked; only when it meets
  // another plane is the beam made of the middle and four rays of its rim.
  void add_echoes(const Neighbourhood& around, std::size_t laser, Sides sides, const Optics& optics,
                  Echoes& echoes) const noexcept;

 private:
  // Opposites are i, i ^ 1.
  static constexpr std::size_t kBefore = 0;
  static constexpr std::size_t kNext = 1;
  static constexpr std::size_t kBelow = 2;
  static constexpr std::size_t kAbove = 3;
  static constexpr std::size_t kSides = 4;
  static constexpr std::size_t kNone = Column::kLasers;

  struct Rim {
    bool cast = false;
    bool met = false;
    Ray ray;
    Hit hit;
  };
  using Rims = std::array<Rim, kSides>;

  // The neighbour on the other side of an edge: its direction.
  [[nodiscard]] const Ray* neighbour(const Neighbourhood& around, std::size_t laser,
                                     std::size_t side) const noexcept;
  [[nodiscard]] bool finds_edge(const Neighbourhood& around, std::size_t laser, Sides sides,
                                Rims& rims) const noexcept;
  void cast(const Neighbourhood& around, std::size_t laser, std::size_t side,
            Rim& rim) const noexcept;

  double radius_;                                     // of the beam at 1 m
  std::array<std::size_t, Column::kLasers> below_{};  // the laser of the next ring, or kNone
  std::array<std::size_t, Column::kLasers> above_{};
};

}  // namespace convexcut::simulation
