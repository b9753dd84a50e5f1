// SPDX-License-Identifier: Apache-2.0
//
// A picture in memory and smooth drawing on it. Pixel coordinates: x to the right, y down, the
// middle of the first pixel at (0.5, 0.5). What lies outside is not drawn.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace convexcut::replay {

struct Colour {  // sRGB, 0 … 1
  float red = 0.0F;
  float green = 0.0F;
  float blue = 0.0F;

  [[nodiscard]] static constexpr Colour hex(std::uint32_t rgb) noexcept {
    constexpr auto part = [](std::uint32_t bits) {
      return static_cast<float>(bits & 0xFFU) / 255.0F;
    };
    return {part(rgb >> 16U), part(rgb >> 8U), part(rgb)};
  }
};

struct Pixel {
  double x = 0.0;
  double y = 0.0;
};

struct PixelRect {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;

  [[nodiscard]] double right() const noexcept { return left + width; }
  [[nodiscard]] double bottom() const noexcept { return top + height; }
  [[nodiscard]] Pixel centre() const noexcept { return {left + width / 2, top + height / 2}; }
};

// Which part of a text its position names.
enum class Align : std::uint8_t { left, centre, right };

class Canvas {
 public:
  Canvas(int width, int height, Colour background);

  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }

  // Later drawing stays within the rectangle, until the next call.
  void clip(const PixelRect& rect) noexcept;
  void unclip() noexcept;

  // Lays `colour` over one pixel; opacity 0 … 1.
  void blend(int x, int y, Colour colour, double opacity) noexcept;

  void fill(const PixelRect& rect, Colour colour, double opacity = 1.0) noexcept;
  void frame(const PixelRect& rect, Colour colour, double width) noexcept;
  void disc(Pixel centre, double radius, Colour colour, double opacity = 1.0) noexcept;
  void ring(Pixel centre, double radius, double width, Colour colour) noexcept;
  void line(Pixel from, Pixel to, double width, Colour colour, double opacity = 1.0) noexcept;
  void dashed_line(Pixel from, Pixel to, double width, double dash, Colour colour) noexcept;
  void closed_line(std::span<const Pixel> corners, double width, Colour colour) noexcept;

  // Corners in either sense of turning.
  void fill_convex(std::span<const Pixel> corners, Colour colour, double opacity) noexcept;

  // The base line's point of the text; `size` is the height of a capital letter.
  void text(Pixel at, double size, Colour colour, std::string_view words,
            Align align = Align::left) noexcept;
  [[nodiscard]] static double text_width(double size, std::string_view words) noexcept;

  // The bytes of a PNG file, 8 bits a channel. Throws std::runtime_error of one line.
  [[nodiscard]] std::string png() const;

  // The same in a file. The file gets its name only when it is whole. Throws std::runtime_error of
  // one line.
  void write_png(const std::filesystem::path& file) const;

 private:
  // Calls coverage(centre of pixel) for the pixels around a box and blends by what it gives.
  template <class Coverage>
  void shade(double left, double top, double right, double bottom, Colour colour, double opacity,
             Coverage&& coverage) noexcept;
  void character(Pixel base, double dot, Colour colour, char c) noexcept;

  int width_;
  int height_;
  int clip_left_ = 0;
  int clip_top_ = 0;
  int clip_right_;
  int clip_bottom_;
  std::vector<Colour> pixels_;
};

}  // namespace convexcut::replay
