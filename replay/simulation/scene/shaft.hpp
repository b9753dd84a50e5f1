// SPDX-License-Identifier: Apache-2.0
//
// Rays that are nearly the same, and what they may meet: looked for once for all of them (E. Haines
// and J. Wallace, "Shaft culling for efficient ray-cast radiosity", 1991).
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "replay/simulation/scene/bounds.hpp"
#include "replay/simulation/scene/eight_boxes.hpp"
#include "replay/simulation/scene/four_floats.hpp"
#include "replay/simulation/scene/ray.hpp"

namespace convexcut::simulation {

// Bounds of the rays' origins and directions, in the world.
struct Shaft {
  Bounds origins;
  Bounds directions;
  void add(const Ray& ray) noexcept {
    origins.add(ray.origin);
    directions.add(ray.direction);
  }
  // Takes in all directions that differ from those in it by so much.
  void widen(double directions_by) noexcept {
    directions.low.array() -= directions_by;
    directions.high.array() += directions_by;
  }
};

// A shaft as the boxes need it: what BoxRay is for a ray.
class BoxShaft {
 public:
  explicit BoxShaft(const Shaft& shaft) noexcept;

  // Calls met(lane, where a ray enters at the earliest, ≥ 0) for each box that a ray of the shaft
  // may meet.
  template <class Met>
  void meet(const EightBoxes& boxes, Met&& met) const noexcept {
    unsigned hits = 0;
    EightBoxes::Lanes enters;
    for (std::size_t first = 0; first < EightBoxes::kLanes; first += 4) {
      Floats enter = all(0.0F);
      Floats leave = all(std::numeric_limits<float>::infinity());
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Side& up = up_[axis];
        const Side& down = down_[axis];
        const Floats to_low = (load(boxes.sides[0][axis].data() + first) - up.origin) * up.inverse;
        const Floats to_high =
            (load(boxes.sides[1][axis].data() + first) - down.origin) * down.inverse;
        if (up.inwards) {
          enter = larger(enter, to_low);
        } else {
          leave = smaller(leave, to_low);
        }
        if (down.inwards) {
          enter = larger(enter, to_high);
        } else {
          leave = smaller(leave, to_high);
        }
      }
      hits |= bits_of(enter <= leave * all(1.0F + BoxRay::kRelativeSlack)) << first;
      std::memcpy(enters.data() + first, &enter, sizeof enter);
    }
    for (; hits != 0; hits &= hits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(hits));
      met(lane, enters[lane]);
    }
  }

 private:
  // The shaft's highest or lowest coordinate on an axis at distance t is origin + t / inverse. A
  // box is between its low side, which the highest has to pass, and its high side: inwards, when
  // the distance from which on it has is to be asked, and not the distance up to which.
  struct Side {
    Floats origin;
    Floats inverse;
    bool inwards;
  };
  std::array<Side, 3> up_;
  std::array<Side, 3> down_;
};

// What the rays of a shaft may meet, the nearest first; SceneAt::gather() fills it.
class InShaft {
 public:
  // Forgets what is in it, and keeps the memory.
  void begin() noexcept { found_.clear(); }
  // `enter`: where a ray enters the box at the earliest. The boxes stay until finish().
  void add(std::uint32_t thing, float enter, const EightBoxes& boxes, std::size_t lane) {
    found_.push_back(
        {std::uint64_t{std::bit_cast<std::uint32_t>(enter)} << 32U | thing, &boxes, lane});
  }
  void finish();

 private:
  friend class SceneAt;
  [[nodiscard]] std::size_t size() const noexcept { return found_.size(); }
  struct Group {
    EightBoxes boxes = EightBoxes::nothing();
    std::array<std::uint32_t, EightBoxes::kLanes> things{};
    float nearest = 0.0F;  // where any ray enters at the earliest
  };
  struct Found {
    std::uint64_t order;  // where it is entered, as bits of a float ≥ 0, above the thing
    const EightBoxes* boxes;
    std::size_t lane;
  };
  std::vector<Group> groups_;
  std::vector<Found> found_;
};

}  // namespace convexcut::simulation
