// SPDX-License-Identifier: Apache-2.0
//
// A cloud in the order of an octree: points of one cell, of whatever size, are neighbours in
// memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/cloud.hpp"
#include "core/planes/plane_options.hpp"
#include "core/workspace.hpp"

namespace convexcut {

// Cells are cubes of the grid with its corner at the cloud's origin; level 0 has the smallest.
class CellTree {
 public:
  // The three coordinates of a cell of some level.
  struct Cell {
    std::uint32_t x, y, z;
  };
  // Points [begin, end) of the sorted cloud.
  struct Range {
    std::uint32_t begin, end;
    [[nodiscard]] std::uint32_t size() const noexcept { return end - begin; }
  };

  explicit CellTree(const PlaneOptions& options);

  // Sorts at most 2³² − 1 points. Points that are not finite, or further than 2²⁰ smallest cells
  // from the origin along an axis, are left out.
  void build(const CloudView& cloud);

  [[nodiscard]] std::uint32_t levels() const noexcept { return levels_; }
  [[nodiscard]] std::size_t size() const noexcept { return x_.size(); }
  [[nodiscard]] Range all() const noexcept { return {0, static_cast<std::uint32_t>(size())}; }

  // The cells of a level within a range that is a cell of a higher one (or all), one by one in the
  // order of memory: the cell that begins at `begin`.
  [[nodiscard]] Range cell_at(std::uint32_t begin, std::uint32_t end,
                              std::uint32_t level) const noexcept;
  // Of the cell that holds a point, and of any cell; keys rise in the order of memory.
  [[nodiscard]] std::uint64_t key(std::uint32_t point, std::uint32_t level) const noexcept {
    return keys_[point] >> (3U * level);
  }
  [[nodiscard]] static Cell cell_of(std::uint64_t key) noexcept;
  [[nodiscard]] static std::uint64_t key_of(const Cell& cell) noexcept;

  // Of the sorted cloud; `index` is a point's place in the cloud that was given.
  [[nodiscard]] const float* x() const noexcept { return x_.data(); }
  [[nodiscard]] const float* y() const noexcept { return y_.data(); }
  [[nodiscard]] const float* z() const noexcept { return z_.data(); }
  [[nodiscard]] std::uint32_t index(std::uint32_t point) const noexcept { return index_[point]; }

 private:
  struct Entry {
    std::uint64_t key;
    std::uint32_t index;
  };
  void take_entries(const CloudView& cloud);
  void sort_entries();

  double cell_m_;  // of level 0
  std::uint32_t levels_;
  unsigned key_bits_ = 0;
  std::vector<Entry> entries_, spare_;
  Workspace<std::uint64_t> keys_;
  Workspace<std::uint32_t> index_;
  Workspace<float> x_, y_, z_;
};

}  // namespace convexcut
