// SPDX-License-Identifier: Apache-2.0
#include "replay/evaluation/error_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "replay/picture/canvas.hpp"
#include "replay/picture/plot.hpp"
#include "replay/picture/theme.hpp"
#include "replay/text.hpp"

namespace convexcut::evaluation {
namespace {

using replay::Canvas;
using replay::Colour;
using replay::Pixel;
using replay::PixelRect;
using replay::Plot;
using simulation::SurfaceLabel;
namespace theme = replay::theme;

constexpr int kWidth = 1600;
constexpr int kHeight = 760;
constexpr double kHeadingBase = 26;
constexpr PixelRect kTopArea{64, 52, 700, 640};
constexpr PixelRect kSliceArea{848, 52, 712, 420};
constexpr double kLegendTop = 560;

// What became of a point, in the order of drawing: errors come last, they are what one looks for.
enum class Outcome : std::uint8_t { unjudged, kept, removed, missed, false_structure };
constexpr std::size_t kOutcomes = 5;

struct Style {
  Colour colour;
  double opacity;
  double radius;
  const char* name;
};
// The errors are Okabe and Ito's vermillion and a near black; what is right is pale.
constexpr std::array<Style, kOutcomes> kStyles{{
    {Colour::hex(0xBBBBBB), 0.15, 0.8, "not judged (ghosts, mixed pixels)"},
    {Colour::hex(0x0072B2), 0.16, 0.9, "structure, kept"},
    {Colour::hex(0x8E9A9F), 0.30, 0.9, "object, removed"},
    {Colour::hex(0x111111), 0.80, 1.3, "structure, removed: costs recall"},
    {Colour::hex(0xD55E00), 0.80, 1.3, "object, kept: costs precision"},
}};

[[nodiscard]] Outcome outcome_of(Label result, SurfaceLabel truth) noexcept {
  const bool kept = result == Label::structure;
  if (truth == SurfaceLabel::none) return Outcome::unjudged;
  if (truth == SurfaceLabel::structure) return kept ? Outcome::kept : Outcome::missed;
  return kept ? Outcome::false_structure : Outcome::removed;
}

[[nodiscard]] bool is_error(Outcome outcome) noexcept { return outcome >= Outcome::missed; }

struct Points {
  std::vector<double> x, y, z;
  std::vector<Outcome> outcome;
};

[[nodiscard]] Points points_of(const ErrorMapInput& input) {
  const std::size_t count = input.cloud.size();
  if (input.cloud.y.size() != count || input.cloud.z.size() != count ||
      input.result.size() != count || input.truth.size() != count) {
    throw std::invalid_argument("cloud, labels and truth of an error map differ in number");
  }
  Points points;
  points.x.assign(input.cloud.x.begin(), input.cloud.x.end());
  points.y.assign(input.cloud.y.begin(), input.cloud.y.end());
  points.z.assign(input.cloud.z.begin(), input.cloud.z.end());
  for (std::size_t i = 0; i < count; ++i) {
    points.outcome.push_back(outcome_of(input.result[i], input.truth[i]));
  }
  return points;
}

// A vertical plane through the lidar and what is near it.
struct Slice {
  static constexpr double kHalfWidth = 0.1;  // m
  static constexpr int kDirections = 180;

  double cos_angle = 1.0;
  double sin_angle = 0.0;
  int degrees = 0;

  [[nodiscard]] static Slice at(int degrees) {
    const double angle = degrees * std::numbers::pi / kDirections;
    return {std::cos(angle), std::sin(angle), degrees};
  }
  [[nodiscard]] bool holds(double x, double y) const {
    return std::abs(y * cos_angle - x * sin_angle) <= kHalfWidth;
  }
  [[nodiscard]] double along(double x, double y) const { return x * cos_angle + y * sin_angle; }
};

// The errors near a slice, for 2° apart.
[[nodiscard]] Slice slice_of_most_errors(const Points& points) {
  std::size_t most = 0;
  Slice best = Slice::at(0);
  for (int degrees = 0; degrees < Slice::kDirections; degrees += 2) {
    const Slice slice = Slice::at(degrees);
    std::size_t errors = 0;
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      errors += is_error(points.outcome[i]) && slice.holds(points.x[i], points.y[i]) ? 1U : 0U;
    }
    if (errors <= most) continue;
    most = errors;
    best = slice;
  }
  return best;
}

// position_of(i) gives where point i is drawn, and whether it is.
template <class PositionOf>
void draw_points(Canvas& canvas, const Points& points, double scale, PositionOf&& position_of) {
  for (std::size_t outcome = 0; outcome < kOutcomes; ++outcome) {
    const Style& style = kStyles[outcome];
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      if (points.outcome[i] != static_cast<Outcome>(outcome)) continue;
      Pixel at;
      if (position_of(i, at)) canvas.disc(at, scale * style.radius, style.colour, style.opacity);
    }
  }
}

void draw_lidar(Canvas& canvas, Pixel at) {
  canvas.disc(at, 6.0, theme::kPaper);
  canvas.ring(at, 5.0, 2.0, theme::kInk);
}

void draw_top_view(Canvas& canvas, const Points& points, const Slice& slice) {
  constexpr double kOutliers = 0.002;
  const Plot plot(kTopArea, replay::extent_of(points.y, kOutliers),
                  replay::extent_of(points.x, kOutliers), Plot::Direction::leftwards);
  canvas.text({kTopArea.left, kHeadingBase}, theme::kHeadingSize, theme::kInk, "From above");
  plot.draw_grid(canvas, "y, to the left (m)", "x, forward (m)");
  canvas.clip(kTopArea);
  draw_points(canvas, points, 1.0, [&](std::size_t i, Pixel& at) {
    at = plot.at(points.y[i], points.x[i]);
    return true;
  });
  constexpr double kFar = 1000.0;  // m: beyond the field
  canvas.dashed_line(plot.at(-kFar * slice.sin_angle, -kFar * slice.cos_angle),
                     plot.at(kFar * slice.sin_angle, kFar * slice.cos_angle), 1.2, 6.0,
                     theme::kInk);
  draw_lidar(canvas, plot.at(0, 0));
  canvas.unclip();
  plot.draw_scale_bar(canvas);
  plot.draw_frame(canvas);
}

void draw_slice(Canvas& canvas, const Points& points, const Slice& slice) {
  std::vector<double> along, up;
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    if (!slice.holds(points.x[i], points.y[i])) continue;
    along.push_back(slice.along(points.x[i], points.y[i]));
    up.push_back(points.z[i]);
  }
  const Plot plot(kSliceArea, replay::extent_of(along, 0.0), replay::extent_of(up, 0.0));
  canvas.text({kSliceArea.left, kHeadingBase}, theme::kHeadingSize, theme::kInk,
              replay::format("The slice with the most errors: %d deg from x towards y, 0.2 m wide",
                             slice.degrees));
  plot.draw_grid(canvas, "along the slice (m)", "z, up (m)");
  canvas.clip(kSliceArea);
  draw_points(canvas, points, 1.8, [&](std::size_t i, Pixel& at) {
    at = plot.at(slice.along(points.x[i], points.y[i]), points.z[i]);
    return slice.holds(points.x[i], points.y[i]);
  });
  draw_lidar(canvas, plot.at(0, 0));
  canvas.unclip();
  plot.draw_scale_bar(canvas);
  plot.draw_frame(canvas);
}

void draw_legend(Canvas& canvas, const Points& points) {
  double y = kLegendTop;
  for (std::size_t outcome = kOutcomes; outcome-- > 0;) {
    const Style& style = kStyles[outcome];
    const auto count = static_cast<std::uint64_t>(
        std::ranges::count(points.outcome, static_cast<Outcome>(outcome)));
    canvas.disc({kSliceArea.left + 12, y - theme::kTextSize / 2}, 6.0, style.colour);
    canvas.text({kSliceArea.left + 36, y}, theme::kTextSize, theme::kInk, style.name);
    canvas.text({kSliceArea.right(), y}, theme::kTextSize, theme::kInk,
                replay::grouped(count) + " points", replay::Align::right);
    y += 32;
  }
}

}  // namespace

std::string error_map_png(const ErrorMapInput& input) {
  const Points points = points_of(input);
  const Slice slice = slice_of_most_errors(points);
  Canvas canvas(kWidth, kHeight, theme::kPaper);
  draw_top_view(canvas, points, slice);
  draw_slice(canvas, points, slice);
  draw_legend(canvas, points);
  return canvas.png();
}

}  // namespace convexcut::evaluation
