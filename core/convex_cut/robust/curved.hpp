// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/convex_cut/robust/model.hpp"
#include "core/convex_cut/robust/plane_grid.hpp"
#include "core/convex_cut/robust/voxel_map.hpp"

namespace convexcut::robust {

// Structure that no plane explains: curved walls, round pillars. Surfels that are the farthest of
// their azimuth, in connected groups that reach the ceiling; and what goes on smoothly from a wall.
class Curved {
 public:
  explicit Curved(std::size_t max_surfels);

  // By surfel: 1 where it is structure.
  [[nodiscard]] std::span<const std::uint8_t> find(const Model& model, const PlaneGrids& grids,
                                                   const VoxelMap& map,
                                                   const Vec3f& origin) noexcept;

 private:
  static constexpr std::size_t kSectors = 360;

  struct Candidate {
    std::uint64_t place = 0;  // of its square of the ground
    std::uint32_t surfel = 0;
    bool visited = false;
  };
  void measure_sectors(const Model& model, const Vec3f& origin) noexcept;
  void collect_candidates(const Model& model, const PlaneGrids& grids,
                          const Vec3f& origin) noexcept;
  void collect_group(std::size_t seed) noexcept;
  void visit_place(std::uint64_t place) noexcept;
  [[nodiscard]] bool is_structure(const Model& model) const noexcept;
  void grow(const Model& model, const PlaneGrids& grids, const VoxelMap& map) noexcept;

  std::array<float, kSectors> farthest_m_{};
  std::vector<Candidate> candidates_;  // by place
  std::vector<std::uint32_t> group_;   // candidates; also the queue of the search for them
  std::vector<std::uint32_t> queue_;   // surfels
  std::vector<std::uint8_t> state_;    // by surfel
  std::vector<std::uint8_t> structure_;
};

}  // namespace convexcut::robust
