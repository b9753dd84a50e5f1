// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace convexcut::replay {

// A character as dots: 9 rows of 5, the leftmost dot in bit 4. Rows 0 … 6 stand on the base line,
// rows 7 and 8 hang below it.
struct Glyph {
  static constexpr int kColumns = 5;
  static constexpr int kRows = 9;
  static constexpr int kRowsAboveBase = 7;

  std::array<std::uint8_t, kRows> rows{};

  [[nodiscard]] constexpr bool dot(int column, int row) const noexcept {
    if (column < 0 || column >= kColumns || row < 0 || row >= kRows) return false;
    const unsigned bits = rows[static_cast<std::size_t>(row)];
    return ((bits >> static_cast<unsigned>(kColumns - 1 - column)) & 1U) != 0;
  }
};

// Printable ASCII; anything else gives "?".
[[nodiscard]] const Glyph& glyph(char character) noexcept;

}  // namespace convexcut::replay
