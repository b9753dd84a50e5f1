// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/cloud.hpp"
#include "replay/picture/canvas.hpp"

namespace convexcut::replay {

// Very many points in a small field: counts them by pixel and label, then colours each pixel by its
// mixture and as strongly as it is full. No point hides another, whatever their order.
class DotDensity {
 public:
  explicit DotDensity(const PixelRect& area);

  void add(Pixel at, Label label) noexcept;
  // What one point adds to its pixel's ink: 0 nothing, large: full at once.
  struct Ink {
    double structure = 0.35;
    double other = 0.8;
  };
  void draw(Canvas& canvas, Ink ink, Colour structure, Colour other) const noexcept;

 private:
  int left_;
  int top_;
  int width_;
  int height_;
  std::vector<std::array<float, 2>> weight_;  // by pixel, then label
};

}  // namespace convexcut::replay
