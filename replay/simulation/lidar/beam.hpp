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

class Beam {
 public:
  explicit Beam(Radians divergence);

  // Adds the echoes of the laser's beam. Where its neighbours in the scan met the plane that it met
  // itself, the middle ray stands for all of it. Elsewhere the rim towards those neighbours is
  // asked; only when it meets another plane is the beam made of the middle and four rays of its
  // rim.
  void add_echoes(const Neighbourhood& around, std::size_t laser, const SceneAt& scene,
                  const Optics& optics, Echoes& echoes) const noexcept;

 private:
  static constexpr std::size_t kSides = 4;  // before, next, below, above: opposites are i, i ^ 1
  static constexpr std::size_t kNone = Column::kLasers;

  struct Rim {
    bool cast = false;
    bool met = false;
    Ray ray;
    Hit hit;
  };
  using Rims = std::array<Rim, kSides>;

  // The neighbour's column and laser.
  struct Side {
    const Column* column = nullptr;
    std::size_t laser = kNone;
  };
  [[nodiscard]] Side side(const Neighbourhood& around, std::size_t laser,
                          std::size_t which) const noexcept;
  // Bit i: the neighbour at side i may have met another plane.
  [[nodiscard]] unsigned differing_sides(const Neighbourhood& around,
                                         std::size_t laser) const noexcept;
  [[nodiscard]] bool finds_edge(const Neighbourhood& around, std::size_t laser, unsigned sides,
                                const SceneAt& scene, Rims& rims) const noexcept;
  void cast(const Neighbourhood& around, std::size_t laser, std::size_t which, const SceneAt& scene,
            Rim& rim) const noexcept;

  double radius_;                                     // of the beam at 1 m
  std::array<std::size_t, Column::kLasers> below_{};  // the laser of the next ring, or kNone
  std::array<std::size_t, Column::kLasers> above_{};
};

}  // namespace convexcut::simulation
