// SPDX-License-Identifier: Apache-2.0
#include "replay/picture/plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "replay/picture/theme.hpp"
#include "replay/text.hpp"

namespace convexcut::replay {
namespace {

constexpr double kLeastGridPixels = 34.0;
constexpr double kLeastNumberPixels = 52.0;
constexpr double kNumberGap = 9.0;  // from the area to its numbers

// The least of 1, 2, 5, 10, … metres that covers as many pixels.
double round_step(double pixels_per_metre, double least_pixels) noexcept {
  const double least = std::max(1.0, least_pixels / pixels_per_metre);
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= least) return factor * decade;
  }
  return 10.0 * decade;
}

// Calls use(metres) for the multiples of `step` within.
template <class Use>
void for_each_step(const Extent& extent, double step, Use&& use) {
  const auto first = static_cast<std::int64_t>(std::ceil(extent.low / step));
  const auto last = static_cast<std::int64_t>(std::floor(extent.high / step));
  for (std::int64_t i = first; i <= last; ++i) use(static_cast<double>(i) * step);
}

}  // namespace

Extent extent_of(std::vector<double> values, double outliers) {
  constexpr double kMargin = 0.04;
  constexpr double kLeast = 1.0;  // m, to both sides of the middle
  Extent extent;
  if (!values.empty()) {
    const auto skipped = static_cast<std::ptrdiff_t>(outliers * static_cast<double>(values.size()));
    std::nth_element(values.begin(), values.begin() + skipped, values.end());
    extent.low = std::min(0.0, values[static_cast<std::size_t>(skipped)]);
    std::nth_element(values.begin(), values.end() - 1 - skipped, values.end());
    extent.high = std::max(0.0, *(values.end() - 1 - skipped));
  }
  const double half = std::max(kLeast, extent.length() * (0.5 + kMargin));
  return {extent.middle() - half, extent.middle() + half};
}

Plot::Plot(const PixelRect& area, Extent horizontal, Extent vertical, Direction across) noexcept
    : area_(area),
      middle_horizontal_(horizontal.middle()),
      middle_vertical_(vertical.middle()),
      sign_(across == Direction::rightwards ? 1.0 : -1.0),
      pixels_per_metre_(
          std::min(area.width / horizontal.length(), area.height / vertical.length())) {}

Pixel Plot::at(double horizontal, double vertical) const noexcept {
  const Pixel centre = area_.centre();
  return {centre.x + sign_ * (horizontal - middle_horizontal_) * pixels_per_metre_,
          centre.y - (vertical - middle_vertical_) * pixels_per_metre_};
}

Extent Plot::shown_horizontal() const noexcept {
  const double half = area_.width / 2 / pixels_per_metre_;
  return {middle_horizontal_ - half, middle_horizontal_ + half};
}

Extent Plot::shown_vertical() const noexcept {
  const double half = area_.height / 2 / pixels_per_metre_;
  return {middle_vertical_ - half, middle_vertical_ + half};
}

void Plot::draw_grid(Canvas& canvas, std::string_view horizontal_name,
                     std::string_view vertical_name) const {
  canvas.fill(area_, theme::kGround);
  canvas.clip(area_);
  const double step = round_step(pixels_per_metre_, kLeastGridPixels);
  for_each_step(shown_horizontal(), step, [&](double metres) {
    const double x = std::round(at(metres, 0).x) + 0.5;
    canvas.line({x, area_.top}, {x, area_.bottom()}, 1.0,
                metres == 0 ? theme::kAxis : theme::kGrid);
  });
  for_each_step(shown_vertical(), step, [&](double metres) {
    const double y = std::round(at(0, metres).y) + 0.5;
    canvas.line({area_.left, y}, {area_.right(), y}, 1.0,
                metres == 0 ? theme::kAxis : theme::kGrid);
  });
  canvas.unclip();

  const double numbers = round_step(pixels_per_metre_, kLeastNumberPixels);
  const double number_base = area_.bottom() + kNumberGap + theme::kNumberSize;
  for_each_step(shown_horizontal(), numbers, [&](double metres) {
    canvas.text({at(metres, 0).x, number_base}, theme::kNumberSize, theme::kQuiet,
                format("%.0f", metres), Align::centre);
  });
  for_each_step(shown_vertical(), numbers, [&](double metres) {
    canvas.text({area_.left - kNumberGap, at(0, metres).y + theme::kNumberSize / 2},
                theme::kNumberSize, theme::kQuiet, format("%.0f", metres), Align::right);
  });
  canvas.text({area_.centre().x, number_base + theme::kNumberSize + 11}, theme::kNumberSize,
              theme::kQuiet, horizontal_name, Align::centre);
  canvas.text({area_.left, area_.top - kNumberGap}, theme::kNumberSize, theme::kQuiet,
              vertical_name, Align::left);
}

void Plot::draw_scale_bar(Canvas& canvas) const {
  constexpr double kMargin = 16.0;
  const double metres = round_step(pixels_per_metre_, kLeastNumberPixels);
  const double length = metres * pixels_per_metre_;
  const Pixel end{area_.right() - kMargin, area_.bottom() - kMargin};
  const Pixel begin{end.x - length, end.y};
  const PixelRect ground{begin.x - 8, begin.y - 26, length + 16, 34};
  canvas.fill(ground, theme::kPaper, 0.85);
  for (const Pixel tip : {begin, end}) {
    canvas.line({tip.x, tip.y - 4}, {tip.x, tip.y + 4}, 2.0, theme::kInk);
  }
  canvas.line(begin, end, 2.0, theme::kInk);
  canvas.text({(begin.x + end.x) / 2, begin.y - 9}, theme::kNumberSize, theme::kInk,
              format("%.0f m", metres), Align::centre);
}

void Plot::draw_frame(Canvas& canvas) const { canvas.frame(area_, theme::kAxis, 1.0); }

}  // namespace convexcut::replay
