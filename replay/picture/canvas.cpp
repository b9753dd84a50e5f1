// SPDX-License-Identifier: Apache-2.0
#include "replay/picture/canvas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include <png.h>

#include "replay/atomic_file.hpp"
#include "replay/picture/font.hpp"

namespace convexcut::replay {
namespace {

constexpr double kAdvance = 6.0;        // dots from one character to the next
constexpr double kStrokeRadius = 0.52;  // of the line through the dots, in dots

double distance_to_segment(Pixel p, Pixel a, Pixel b) noexcept {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double length2 = dx * dx + dy * dy;
  const double along = (p.x - a.x) * dx + (p.y - a.y) * dy;
  const double t = length2 > 0.0 ? std::clamp(along / length2, 0.0, 1.0) : 0.0;
  return std::hypot(p.x - (a.x + t * dx), p.y - (a.y + t * dy));
}

// How much of a pixel lies within `radius` of something at `distance`: a linear edge one pixel
// wide.
double edge(double distance, double radius) noexcept {
  return std::clamp(radius - distance + 0.5, 0.0, 1.0);
}

std::uint8_t byte(float channel) noexcept {
  return static_cast<std::uint8_t>(std::lround(std::clamp(channel, 0.0F, 1.0F) * 255.0F));
}

}  // namespace

Canvas::Canvas(int width, int height, Colour background)
    : width_(width),
      height_(height),
      clip_right_(width),
      clip_bottom_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), background) {}

void Canvas::clip(const PixelRect& rect) noexcept {
  clip_left_ = std::max(0, static_cast<int>(std::lround(rect.left)));
  clip_top_ = std::max(0, static_cast<int>(std::lround(rect.top)));
  clip_right_ = std::min(width_, static_cast<int>(std::lround(rect.right())));
  clip_bottom_ = std::min(height_, static_cast<int>(std::lround(rect.bottom())));
}

void Canvas::unclip() noexcept {
  clip_left_ = 0;
  clip_top_ = 0;
  clip_right_ = width_;
  clip_bottom_ = height_;
}

void Canvas::blend(int x, int y, Colour colour, double opacity) noexcept {
  if (x < clip_left_ || x >= clip_right_ || y < clip_top_ || y >= clip_bottom_) return;
  Colour& pixel = pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                          static_cast<std::size_t>(x)];
  const auto share = static_cast<float>(opacity);
  pixel.red += (colour.red - pixel.red) * share;
  pixel.green += (colour.green - pixel.green) * share;
  pixel.blue += (colour.blue - pixel.blue) * share;
}

template <class Coverage>
void Canvas::shade(double left, double top, double right, double bottom, Colour colour,
                   double opacity, Coverage&& coverage) noexcept {
  // Clamped before the conversion: coordinates far outside do not fit an int.
  const auto whole = [](double value, int low, int high) {
    return static_cast<int>(std::clamp(value, static_cast<double>(low), static_cast<double>(high)));
  };
  const int first_x = whole(std::floor(left) - 1, clip_left_, clip_right_);
  const int last_x = whole(std::ceil(right) + 1, clip_left_, clip_right_);
  const int first_y = whole(std::floor(top) - 1, clip_top_, clip_bottom_);
  const int last_y = whole(std::ceil(bottom) + 1, clip_top_, clip_bottom_);
  for (int y = first_y; y < last_y; ++y) {
    for (int x = first_x; x < last_x; ++x) {
      const double share = coverage(Pixel{x + 0.5, y + 0.5});
      if (share > 0.0) blend(x, y, colour, opacity * share);
    }
  }
}

void Canvas::fill(const PixelRect& rect, Colour colour, double opacity) noexcept {
  shade(rect.left, rect.top, rect.right(), rect.bottom(), colour, opacity, [&](Pixel p) {
    const double horizontal = std::min(p.x - rect.left, rect.right() - p.x);
    const double vertical = std::min(p.y - rect.top, rect.bottom() - p.y);
    return edge(-horizontal, 0.0) * edge(-vertical, 0.0);
  });
}

void Canvas::frame(const PixelRect& rect, Colour colour, double width) noexcept {
  const std::array corners{Pixel{rect.left, rect.top}, Pixel{rect.right(), rect.top},
                           Pixel{rect.right(), rect.bottom()}, Pixel{rect.left, rect.bottom()}};
  closed_line(corners, width, colour);
}

void Canvas::disc(Pixel centre, double radius, Colour colour, double opacity) noexcept {
  shade(centre.x - radius, centre.y - radius, centre.x + radius, centre.y + radius, colour, opacity,
        [&](Pixel p) { return edge(std::hypot(p.x - centre.x, p.y - centre.y), radius); });
}

void Canvas::ring(Pixel centre, double radius, double width, Colour colour) noexcept {
  const double outer = radius + width / 2;
  shade(centre.x - outer, centre.y - outer, centre.x + outer, centre.y + outer, colour, 1.0,
        [&](Pixel p) {
          const double from_line = std::abs(std::hypot(p.x - centre.x, p.y - centre.y) - radius);
          return edge(from_line, width / 2);
        });
}

void Canvas::line(Pixel from, Pixel to, double width, Colour colour, double opacity) noexcept {
  const double radius = width / 2;
  shade(std::min(from.x, to.x) - radius, std::min(from.y, to.y) - radius,
        std::max(from.x, to.x) + radius, std::max(from.y, to.y) + radius, colour, opacity,
        [&](Pixel p) { return edge(distance_to_segment(p, from, to), radius); });
}

void Canvas::dashed_line(Pixel from, Pixel to, double width, double dash, Colour colour) noexcept {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  if (!(length > 0.0)) return;
  const auto at = [&](double along) {
    return Pixel{from.x + (to.x - from.x) * along / length,
                 from.y + (to.y - from.y) * along / length};
  };
  const auto dashes = static_cast<int>(std::ceil(length / (2 * dash)));
  for (int i = 0; i < dashes; ++i) {
    const double begin = 2 * dash * i;
    line(at(begin), at(std::min(begin + dash, length)), width, colour);
  }
}

void Canvas::closed_line(std::span<const Pixel> corners, double width, Colour colour) noexcept {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    line(corners[i], corners[(i + 1) % corners.size()], width, colour);
  }
}

void Canvas::fill_convex(std::span<const Pixel> corners, Colour colour, double opacity) noexcept {
  if (corners.size() < 3) return;
  const auto [left, right] = std::ranges::minmax_element(corners, {}, &Pixel::x);
  const auto [top, bottom] = std::ranges::minmax_element(corners, {}, &Pixel::y);
  shade(left->x, top->y, right->x, bottom->y, colour, opacity, [&](Pixel p) {
    bool clockwise = true;
    bool counter_clockwise = true;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Pixel a = corners[i];
      const Pixel b = corners[(i + 1) % corners.size()];
      const double side = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
      clockwise = clockwise && side >= 0;
      counter_clockwise = counter_clockwise && side <= 0;
    }
    return clockwise || counter_clockwise ? 1.0 : 0.0;
  });
}

double Canvas::text_width(double size, std::string_view words) noexcept {
  const double dot = size / Glyph::kRowsAboveBase;
  return words.empty() ? 0.0 : (static_cast<double>(words.size()) * kAdvance - 1.0) * dot;
}

void Canvas::text(Pixel at, double size, Colour colour, std::string_view words,
                  Align align) noexcept {
  const double dot = size / Glyph::kRowsAboveBase;
  const double width = text_width(size, words);
  if (align == Align::centre) at.x -= width / 2;
  if (align == Align::right) at.x -= width;
  for (const char c : words) {
    character(at, dot, colour, c);
    at.x += kAdvance * dot;
  }
}

// The dots of a character are joined by strokes with round ends, which is smooth at every size.
void Canvas::character(Pixel base, double dot, Colour colour, char c) noexcept {
  const Glyph& shape = glyph(c);
  const auto place = [&](int column, int row) {
    return Pixel{base.x + (column + 0.5) * dot, base.y + (row + 0.5 - Glyph::kRowsAboveBase) * dot};
  };
  std::vector<std::pair<Pixel, Pixel>> strokes;
  for (int row = 0; row < Glyph::kRows; ++row) {
    for (int column = 0; column < Glyph::kColumns; ++column) {
      if (!shape.dot(column, row)) continue;
      const Pixel here = place(column, row);
      const bool right = shape.dot(column + 1, row);
      const bool below = shape.dot(column, row + 1);
      strokes.emplace_back(here, here);
      if (right) strokes.emplace_back(here, place(column + 1, row));
      if (below) strokes.emplace_back(here, place(column, row + 1));
      // A slanting stroke only where no straight one goes the same way.
      if (shape.dot(column + 1, row + 1) && !right && !below) {
        strokes.emplace_back(here, place(column + 1, row + 1));
      }
      if (shape.dot(column - 1, row + 1) && !shape.dot(column - 1, row) && !below) {
        strokes.emplace_back(here, place(column - 1, row + 1));
      }
    }
  }
  const double top = base.y - Glyph::kRowsAboveBase * dot;
  shade(base.x - dot, top - dot, base.x + (Glyph::kColumns + 1) * dot,
        top + (Glyph::kRows + 1) * dot, colour, 1.0, [&](Pixel p) {
          double share = 0.0;
          for (const auto& [from, to] : strokes) {
            share = std::max(share, edge(distance_to_segment(p, from, to), kStrokeRadius * dot));
          }
          return share;
        });
}

std::string Canvas::png() const {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(pixels_.size() * 3);
  for (const Colour& pixel : pixels_) {
    rgb.insert(rgb.end(), {byte(pixel.red), byte(pixel.green), byte(pixel.blue)});
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_);
  image.height = static_cast<png_uint_32>(height_);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string png(size, '\0');
  if (png_image_write_to_memory(&image, png.data(), &size, 0, rgb.data(), 0, nullptr) == 0) {
    throw std::runtime_error(std::string("cannot encode a PNG: ") + image.message);
  }
  png.resize(size);
  return png;
}

void Canvas::write_png(const std::filesystem::path& file) const {
  AtomicFile out(file);
  out.write(png());
  out.commit();
}

}  // namespace convexcut::replay
