// SPDX-License-Identifier: Apache-2.0
//
// A field of a picture with metres along both sides, at one scale.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "replay/picture/canvas.hpp"

namespace convexcut::replay {

struct Extent {  // metres
  double low = 0.0;
  double high = 0.0;
  [[nodiscard]] double middle() const noexcept { return (low + high) / 2; }
  [[nodiscard]] double length() const noexcept { return high - low; }
};

// Where the values and the origin are, with a margin; but for a share of them at each end.
[[nodiscard]] Extent extent_of(std::vector<double> values, double outliers);

class Plot {
 public:
  enum class Direction : std::uint8_t { rightwards, leftwards };

  // Shows both extents whole in `area`, and more of one of them where the shapes differ.
  // `across` says which way the horizontal axis counts up; the vertical one always counts upwards.
  Plot(const PixelRect& area, Extent horizontal, Extent vertical,
       Direction across = Direction::rightwards) noexcept;

  [[nodiscard]] Pixel at(double horizontal, double vertical) const noexcept;
  [[nodiscard]] const PixelRect& area() const noexcept { return area_; }
  [[nodiscard]] double pixels_per_metre() const noexcept { return pixels_per_metre_; }

  // Ground, grid lines, numbers and names of the axes. Numbers are outside the area.
  void draw_grid(Canvas& canvas, std::string_view horizontal_name,
                 std::string_view vertical_name) const;
  // In the lower right corner of the area.
  void draw_scale_bar(Canvas& canvas) const;
  void draw_frame(Canvas& canvas) const;

 private:
  [[nodiscard]] Extent shown_horizontal() const noexcept;
  [[nodiscard]] Extent shown_vertical() const noexcept;

  PixelRect area_;
  double middle_horizontal_;
  double middle_vertical_;
  double sign_;  // of the horizontal axis
  double pixels_per_metre_;
};

}  // namespace convexcut::replay
