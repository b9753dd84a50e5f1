// SPDX-License-Identifier: Apache-2.0
//
// A set of a plane's cells, a byte each: a neighbourhood's row is read at once.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace convexcut::robust {

class CellSet {
 public:
  static constexpr std::int32_t kReach = 2;  // of take_around()

  explicit CellSet(std::size_t max_cells) { in_.reserve(max_cells + kPadding); }

  // All cells of a rectangle, or none.
  void assign(std::int32_t columns, std::int32_t rows, bool all) noexcept {
    columns_ = columns;
    in_.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) + kPadding,
               all ? 1 : 0);
  }
  void insert(std::int32_t column, std::int32_t row) noexcept { in_[index(column, row)] = 1; }
  void erase(std::int32_t column, std::int32_t row) noexcept { in_[index(column, row)] = 0; }
  [[nodiscard]] bool contains(std::int32_t column, std::int32_t row) const noexcept {
    return in_[index(column, row)] != 0;
  }

  // Takes those within kReach out, and calls visit(column, row) for each. The place is at least as
  // far from the rectangle's border.
  template <class Visit>
  void take_around(std::int32_t column, std::int32_t row, Visit&& visit) noexcept {
    static_assert(std::endian::native == std::endian::little);
    constexpr std::uint64_t kRow = (std::uint64_t{1} << 8U * (2 * kReach + 1)) - 1;
    for (std::int32_t r = row - kReach; r <= row + kReach; ++r) {
      std::uint8_t* const first = &in_[index(column - kReach, r)];
      std::uint64_t left = 0;
      std::memcpy(&left, first, sizeof(left));
      for (left &= kRow; left != 0; left &= left - 1) {
        const std::int32_t at = std::countr_zero(left) / 8;
        first[at] = 0;
        visit(column - kReach + at, r);
      }
    }
  }

 private:
  static constexpr std::size_t kPadding = sizeof(std::uint64_t);

  [[nodiscard]] std::size_t index(std::int32_t column, std::int32_t row) const noexcept {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  std::vector<std::uint8_t> in_;
  std::int32_t columns_ = 0;
};

}  // namespace convexcut::robust
