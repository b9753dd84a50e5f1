// SPDX-License-Identifier: Apache-2.0
#include "replay/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "core/convex_cut/reference.hpp"
#include "replay/picture/canvas.hpp"
#include "replay/picture/dot_density.hpp"
#include "replay/picture/plot.hpp"
#include "replay/picture/theme.hpp"
#include "replay/text.hpp"

namespace convexcut::replay {
namespace {

constexpr int kWidth = 1600;
constexpr int kHeight = 820;
constexpr double kTitleBase = 34;  // base lines of the text above the plots
constexpr double kHeadingBase = 70;
constexpr PixelRect kTopArea{64, 100, 700, 652};
constexpr PixelRect kSliceArea{848, 100, 712, 340};
constexpr PixelRect kLegendArea{848, 536, 712, 216};

// The points that are drawn.
struct Cloud {
  std::vector<float> x, y, z;
  std::vector<Label> label;
  bool labelled = false;

  [[nodiscard]] CloudView view() const noexcept { return {x, y, z}; }
  [[nodiscard]] std::size_t structure() const {
    return static_cast<std::size_t>(std::ranges::count(label, Label::structure));
  }
};

Cloud drawable(const PictureInput& input) {
  const CloudView& in = input.cloud;
  if (in.y.size() != in.size() || in.z.size() != in.size() ||
      (!input.label.empty() && input.label.size() != in.size())) {
    throw std::invalid_argument("coordinates and labels of a picture differ in number");
  }
  Cloud out;
  out.labelled = !input.label.empty();
  for (std::size_t i = 0; i < in.size(); ++i) {
    const bool finite = std::isfinite(in.x[i]) && std::isfinite(in.y[i]) && std::isfinite(in.z[i]);
    const bool no_return = in.x[i] == 0 && in.y[i] == 0 && in.z[i] == 0;
    if (!finite || no_return) continue;
    out.x.push_back(in.x[i]);
    out.y.push_back(in.y[i]);
    out.z.push_back(in.z[i]);
    out.label.push_back(out.labelled ? input.label[i] : Label::structure);
  }
  return out;
}

struct Palette {
  Colour structure;
  Colour other;
};

Palette palette(const Cloud& cloud) {
  return {cloud.labelled ? theme::kStructure : theme::kUnlabelled, theme::kOther};
}

void draw_lidar(Canvas& canvas, Pixel at) {
  canvas.disc(at, 7.0, theme::kPaper);
  canvas.ring(at, 5.5, 2.0, theme::kInk);
  canvas.disc(at, 2.2, theme::kInk);
}

// The two ends of the slicing plane carry these letters in both plots.
constexpr std::string_view kBehind = "A";
constexpr std::string_view kAhead = "B";

void draw_end_mark(Canvas& canvas, Pixel at, std::string_view letter) {
  canvas.disc(at, 10.0, theme::kInk);
  canvas.text({at.x + 0.5, at.y + theme::kNumberSize / 2}, theme::kNumberSize, theme::kPaper,
              letter, Align::centre);
}

// Where a ray from `from` in direction (dx, dy) leaves the rectangle shrunk by `inset`.
Pixel border(Pixel from, double dx, double dy, const PixelRect& rect, double inset) {
  const auto reach = [](double at, double direction, double low, double high) {
    if (direction > 0) return (high - at) / direction;
    if (direction < 0) return (low - at) / direction;
    return HUGE_VAL;
  };
  const double t = std::min(reach(from.x, dx, rect.left + inset, rect.right() - inset),
                            reach(from.y, dy, rect.top + inset, rect.bottom() - inset));
  return {from.x + t * dx, from.y + t * dy};
}

void draw_top_view(Canvas& canvas, const Cloud& cloud, const SlicingPlane& plane) {
  // A few far returns through a door must not shrink the room to a dot.
  constexpr double kOutliers = 0.002;
  const Plot plot(kTopArea, extent_of({cloud.y.begin(), cloud.y.end()}, kOutliers),
                  extent_of({cloud.x.begin(), cloud.x.end()}, kOutliers),
                  Plot::Direction::leftwards);
  canvas.text({kTopArea.left, kHeadingBase}, theme::kHeadingSize, theme::kInk, "From above");
  plot.draw_grid(canvas, "y, to the left (m)", "x, forward (m)");

  DotDensity dots(kTopArea);
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    dots.add(plot.at(static_cast<double>(cloud.y[i]), static_cast<double>(cloud.x[i])),
             cloud.label[i]);
  }
  const auto [structure, other] = palette(cloud);
  dots.draw(canvas, {}, structure, other);

  const Pixel lidar = plot.at(0, 0);
  // Pixels run left and down where y and x run up.
  const Pixel ahead = border(lidar, -plane.sin_theta, -plane.cos_theta, kTopArea, 16);
  const Pixel behind = border(lidar, plane.sin_theta, plane.cos_theta, kTopArea, 16);
  canvas.dashed_line(behind, ahead, 1.4, 6.0, theme::kInk);
  draw_end_mark(canvas, behind, kBehind);
  draw_end_mark(canvas, ahead, kAhead);
  draw_lidar(canvas, lidar);
  plot.draw_scale_bar(canvas);
  plot.draw_frame(canvas);
}

struct Slice {
  std::vector<std::size_t> members;  // indices into the cloud
  std::vector<SlicePoint> points;    // in the same order
  std::vector<SlicePoint> hull;
};

Slice slice_of(const Cloud& cloud, const SlicingPlane& plane, double half_width_m) {
  Slice slice;
  slice.members = reference::cut(cloud.view(), plane, half_width_m);
  slice.points = reference::project(cloud.view(), plane, slice.members);
  slice.hull = reference::hull(slice.points);
  return slice;
}

void draw_slice(Canvas& canvas, const Cloud& cloud, const Slice& slice) {
  std::vector<double> u;
  std::vector<double> z;
  for (const SlicePoint& vertex : slice.hull) {
    u.push_back(vertex.u);
    z.push_back(vertex.z);
  }
  // The hull is shown whole: a far corner is what explains its shape.
  const Plot plot(kSliceArea, extent_of(u, 0.0), extent_of(z, 0.0));
  canvas.text({kSliceArea.left, kHeadingBase}, theme::kHeadingSize, theme::kInk, "Slice A - B");
  plot.draw_grid(canvas, "along the slice (m)", "z, up (m)");

  canvas.clip(kSliceArea);
  std::vector<Pixel> corners;
  for (const SlicePoint& vertex : slice.hull) corners.push_back(plot.at(vertex.u, vertex.z));
  const auto [structure, other] = palette(cloud);
  canvas.fill_convex(corners, structure, 0.05);
  canvas.closed_line(corners, 1.4, theme::kInk);
  // The rest comes last: it is what one looks for, and it is less.
  for (const Label label : {Label::structure, Label::other}) {
    for (std::size_t i = 0; i < slice.points.size(); ++i) {
      if (cloud.label[slice.members[i]] != label) continue;
      const bool is_structure = label == Label::structure;
      canvas.disc(plot.at(slice.points[i].u, slice.points[i].z), 1.9,
                  is_structure ? structure : other, 0.75);
    }
  }
  draw_lidar(canvas, plot.at(0, 0));
  const double mark_y = kSliceArea.top + 18;
  draw_end_mark(canvas, {kSliceArea.left + 18, mark_y}, kBehind);
  draw_end_mark(canvas, {kSliceArea.right() - 18, mark_y}, kAhead);
  canvas.unclip();
  plot.draw_scale_bar(canvas);
  plot.draw_frame(canvas);
}

// The title, without its middle where it is too long: file names begin and end with what matters.
std::string fitted(const std::string& title, double size, double width) {
  if (Canvas::text_width(size, title) <= width) return title;
  const auto room = static_cast<std::size_t>(width / Canvas::text_width(size, "-----") * 4.0);
  const std::size_t half = std::min(room, title.size()) / 2;
  return title.substr(0, half) + "..." + title.substr(title.size() - half);
}

std::string share(std::size_t part, std::size_t whole) {
  const double percent =
      whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  return format("%.1f %%", percent);
}

// One row of the legend: a sample of the mark, its name, and figures in two columns.
class Legend {
 public:
  explicit Legend(Canvas& canvas) : canvas_(canvas) {}

  void headings() {
    text(kName, "", theme::kQuiet);
    text_right(kWhole, "whole scan", theme::kQuiet);
    text_right(kSlice, "slice", theme::kQuiet);
    next();
    canvas_.line({kLegendArea.left, y_ - 26}, {kLegendArea.right(), y_ - 26}, 1.0, theme::kGrid);
  }
  void points(Colour colour, std::string_view name, std::size_t whole, std::size_t whole_of,
              std::size_t slice, std::size_t slice_of) {
    canvas_.disc(sample(), 6.0, colour);
    text(kName, name, theme::kInk);
    text_right(kWhole - 90, grouped(whole), theme::kInk);
    text_right(kWhole, share(whole, whole_of), theme::kQuiet);
    text_right(kSlice - 90, grouped(slice), theme::kInk);
    text_right(kSlice, share(slice, slice_of), theme::kQuiet);
    next();
  }
  void hull(std::size_t corners) {
    const Pixel at = sample();
    canvas_.line({at.x - 10, at.y}, {at.x + 10, at.y}, 1.6, theme::kInk);
    text(kName, "convex hull of the slice", theme::kInk);
    text_right(kSlice, format("%zu corners", corners), theme::kInk);
    next();
  }
  void plane(Degrees angle, double half_width_m) {
    const Pixel at = sample();
    canvas_.dashed_line({at.x - 10, at.y}, {at.x + 10, at.y}, 1.6, 4.0, theme::kInk);
    text(kName,
         format("slicing plane, %.1f deg from x, %.2f m to both sides", angle.value, half_width_m),
         theme::kInk);
    next();
  }
  void lidar() {
    draw_lidar(canvas_, sample());
    text(kName, "lidar", theme::kInk);
    next();
  }

 private:
  static constexpr double kName = kLegendArea.left + 40;
  static constexpr double kWhole = kLegendArea.left + 510;
  static constexpr double kSlice = kLegendArea.left + kLegendArea.width;
  static constexpr double kRow = 34.0;

  [[nodiscard]] Pixel sample() const { return {kLegendArea.left + 14, y_ - theme::kTextSize / 2}; }
  void text(double x, std::string_view words, Colour colour) {
    canvas_.text({x, y_}, theme::kTextSize, colour, words);
  }
  void text_right(double x, std::string_view words, Colour colour) {
    canvas_.text({x, y_}, theme::kTextSize, colour, words, Align::right);
  }
  void next() { y_ += kRow; }

  Canvas& canvas_;
  double y_ = kLegendArea.top + theme::kTextSize;
};

void draw_legend(Canvas& canvas, const Cloud& cloud, const Slice& slice,
                 const PictureInput& input) {
  const std::size_t all = cloud.label.size();
  const std::size_t in_slice = slice.members.size();
  const auto slice_structure = static_cast<std::size_t>(std::ranges::count_if(
      slice.members, [&](std::size_t i) { return cloud.label[i] == Label::structure; }));
  const auto [structure, other] = palette(cloud);
  Legend legend(canvas);
  legend.headings();
  if (cloud.labelled) {
    legend.points(structure, "structure", cloud.structure(), all, slice_structure, in_slice);
    legend.points(other, "other", all - cloud.structure(), all, in_slice - slice_structure,
                  in_slice);
  } else {
    legend.points(structure, "points, not labelled", all, all, in_slice, in_slice);
  }
  legend.hull(slice.hull.size());
  legend.plane(input.slice_angle, input.slice_half_width_m);
  legend.lidar();
}

}  // namespace

void render_picture(const PictureInput& input, const std::filesystem::path& png) {
  const Cloud cloud = drawable(input);
  const double theta = input.slice_angle.to_radians().value;
  const SlicingPlane plane{std::cos(theta), std::sin(theta)};
  const Slice slice = slice_of(cloud, plane, input.slice_half_width_m);

  Canvas canvas(kWidth, kHeight, theme::kPaper);
  canvas.text({kTopArea.left, kTitleBase}, theme::kTitleSize, theme::kInk,
              fitted(input.title, theme::kTitleSize, kSliceArea.right() - kTopArea.left));
  draw_top_view(canvas, cloud, plane);
  draw_slice(canvas, cloud, slice);
  draw_legend(canvas, cloud, slice, input);
  canvas.write_png(png);
}

}  // namespace convexcut::replay
