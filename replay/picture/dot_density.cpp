// SPDX-License-Identifier: Apache-2.0
#include "replay/picture/dot_density.hpp"

#include <algorithm>
#include <cmath>

namespace convexcut::replay {

DotDensity::DotDensity(const PixelRect& area)
    : left_(static_cast<int>(std::lround(area.left))),
      top_(static_cast<int>(std::lround(area.top))),
      width_(static_cast<int>(std::lround(area.width))),
      height_(static_cast<int>(std::lround(area.height))),
      weight_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

// A point is as large as a pixel and is shared among the four that it touches.
void DotDensity::add(Pixel at, Label label) noexcept {
  const double x = at.x - 0.5 - left_;
  const double y = at.y - 0.5 - top_;
  if (!(x >= 0 && x < width_ - 1 && y >= 0 && y < height_ - 1)) return;
  const auto column = static_cast<std::size_t>(x);
  const auto row = static_cast<std::size_t>(y);
  const auto right = static_cast<float>(x - std::floor(x));
  const auto below = static_cast<float>(y - std::floor(y));
  const auto stride = static_cast<std::size_t>(width_);
  const std::size_t which = label == Label::structure ? 1 : 0;
  weight_[row * stride + column][which] += (1 - right) * (1 - below);
  weight_[row * stride + column + 1][which] += right * (1 - below);
  weight_[(row + 1) * stride + column][which] += (1 - right) * below;
  weight_[(row + 1) * stride + column + 1][which] += right * below;
}

void DotDensity::draw(Canvas& canvas, Ink ink, Colour structure, Colour other) const noexcept {
  for (int row = 0; row < height_; ++row) {
    for (int column = 0; column < width_; ++column) {
      const auto& [others, structures] =
          weight_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(column)];
      const double other_ink = ink.other * static_cast<double>(others);
      const double structure_ink = ink.structure * static_cast<double>(structures);
      const double total = other_ink + structure_ink;
      if (total <= 0.0) continue;
      const auto share = static_cast<float>(other_ink / total);
      const Colour mixed{structure.red + (other.red - structure.red) * share,
                         structure.green + (other.green - structure.green) * share,
                         structure.blue + (other.blue - structure.blue) * share};
      canvas.blend(left_ + column, top_ + row, mixed, 1.0 - std::exp(-total));
    }
  }
}

}  // namespace convexcut::replay
