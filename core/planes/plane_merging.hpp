// SPDX-License-Identifier: Apache-2.0
//
// The second step of an extraction: planelets that are near each other and in one plane become one
// patch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/planes/planelets.hpp"

namespace convexcut {

class PlaneMerger {
 public:
  explicit PlaneMerger(const PlaneOptions& options);

  struct Region {
    Moments moments;
    PlaneFit fit;
  };
  struct Regions {
    std::span<const Region> regions;
    std::span<const std::uint32_t> region_of_planelet;
  };

  // Grows regions from the planelets with the most points; then joins regions, until none can be
  // joined. Valid until the next call.
  [[nodiscard]] Regions merge(std::span<const Planelet> planelets);

 private:
  // Two numbers, the smaller first.
  struct Pair {
    std::uint32_t a, b;
    // The zero of a three-way comparison is no pointer. NOLINTNEXTLINE(modernize-use-nullptr)
    friend auto operator<=>(const Pair&, const Pair&) = default;
  };

  void find_neighbours(std::span<const Planelet> planelets);
  void grow(std::span<const Planelet> planelets, std::uint32_t seed);
  [[nodiscard]] bool join_regions();
  void renumber();
  // Whether `small` continues the plane of `large`; if so, `joined` is both.
  [[nodiscard]] bool coplanar(const Region& large, const Region& small, Region& joined) const;

  PlaneOptions options_;
  std::vector<Pair> pairs_;         // of planelets whose boxes are near
  std::vector<Pair> region_pairs_;  // of regions that have such planelets
  std::vector<std::uint32_t> by_x_, by_points_;
  std::vector<std::uint32_t> first_neighbour_;  // of planelet i: neighbours_[first[i]] …
  std::vector<std::uint32_t> neighbours_;
  std::vector<std::uint32_t> queue_;
  std::vector<std::uint32_t> region_of_planelet_;
  std::vector<Region> regions_;
  std::vector<std::uint32_t> joined_into_;  // of each region: itself, or the one that took it
};

}  // namespace convexcut
