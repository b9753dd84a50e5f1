// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/scene/scene_picture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "replay/picture/canvas.hpp"
#include "replay/picture/theme.hpp"

namespace convexcut::simulation {
namespace {

using replay::Canvas;
using replay::Colour;

constexpr int kMargin = 16;
constexpr int kTitleHeight = 32;
constexpr int kWidth = 1440;
constexpr int kLargestTopHeight = 900;
constexpr int kPanoramaHeight = 480;
constexpr double kPanoramaUpDeg = 60.0;  // above and below the horizon

// What is this far above the rig is cut off in the view from above.
constexpr double kCutAboveRigM = 0.7;

Colour colour_of(const SurfaceInfo& surface) {
  if (surface.material == Material::glass) return Colour::hex(0x56B4E9);
  if (surface.material == Material::mirror) return Colour::hex(0xCC79A7);
  switch (surface.label) {
    case SurfaceLabel::structure:
      return Colour::hex(0x9FB3C8);
    case SurfaceLabel::object:
      return Colour::hex(0xE0A458);
    default:
      return Colour::hex(0xC8352E);
  }
}

Colour shaded(Colour colour, double light) {
  const auto factor = static_cast<float>(std::clamp(light, 0.0, 1.0));
  return {colour.red * factor, colour.green * factor, colour.blue * factor};
}

// Brighter where a surface faces the eye, darker where it is dark or far away.
Colour seen(const Scene& scene, const Ray& ray, const Hit& hit) {
  const SurfaceInfo& surface = scene.surfaces()[hit.surface];
  const double facing = -hit.normal.dot(ray.direction);
  const double near = 1.0 / (1.0 + 0.03 * hit.distance_m);
  return shaded(colour_of(surface),
                (0.45 + 0.55 * facing) * near * (0.6 + 0.4 * surface.reflectivity));
}

class TopView {
 public:
  explicit TopView(const Scene& scene) : bounds_(scene.bounds()) {
    const Vec3 size = bounds_.size();
    metres_per_pixel_ = std::max(size.x() / (kWidth - 2 * kMargin), size.y() / kLargestTopHeight);
    width_ = static_cast<int>(size.x() / metres_per_pixel_);
    height_ = static_cast<int>(size.y() / metres_per_pixel_);
    start_z_ = scene.rig().position.z() + kCutAboveRigM;
  }
  [[nodiscard]] int height() const noexcept { return height_; }

  void draw(const Scene& scene, const SceneAt& instant, Canvas& canvas) const {
    for (int row = 0; row < height_; ++row) {
      for (int column = 0; column < width_; ++column) {
        const Ray ray{{bounds_.low.x() + (column + 0.5) * metres_per_pixel_,
                       bounds_.high.y() - (row + 0.5) * metres_per_pixel_, start_z_},
                      -Vec3::UnitZ()};
        Hit hit;
        if (!instant.cast(ray, hit)) continue;
        // Within a solid one meets it below and above: it is cut, and drawn as plans do.
        Hit above;
        const bool is_cut =
            instant.cast({ray.origin, Vec3::UnitZ()}, above) && above.surface == hit.surface;
        const Colour colour =
            is_cut ? shaded(colour_of(scene.surfaces()[hit.surface]), 0.35) : seen(scene, ray, hit);
        canvas.blend(kMargin + column, kTitleHeight + row, colour, 1.0);
      }
    }
    const RigPlan& rig = scene.rig();
    const std::vector<Vec3>& way = rig.path.way_points();
    for (std::size_t i = 1; i < way.size(); ++i) {
      canvas.line(at(way[i - 1]), at(way[i]), 2.0, replay::theme::kInk, 0.7);
    }
    const double yaw = rig.yaw.to_radians().value;
    const Vec3 ahead = rig.position + 0.5 * Vec3(std::cos(yaw), std::sin(yaw), 0.0);
    canvas.line(at(rig.position), at(ahead), 3.0, replay::theme::kInk);
    canvas.disc(at(rig.position), 6.0, replay::theme::kInk);
  }

 private:
  [[nodiscard]] replay::Pixel at(const Vec3& p) const noexcept {
    return {kMargin + (p.x() - bounds_.low.x()) / metres_per_pixel_,
            kTitleHeight + (bounds_.high.y() - p.y()) / metres_per_pixel_};
  }

  Bounds bounds_;
  double metres_per_pixel_ = 1.0;
  double start_z_ = 0.0;
  int width_ = 0;
  int height_ = 0;
};

// Azimuth to the right (clockwise from above), elevation upwards; ahead is in the middle.
void draw_panorama(const Scene& scene, const SceneAt& instant, int top, Canvas& canvas) {
  const int width = kWidth - 2 * kMargin;
  const RigPlan& rig = scene.rig();
  for (int row = 0; row < kPanoramaHeight; ++row) {
    const double part = (row + 0.5) / kPanoramaHeight;
    const double elevation = Degrees{kPanoramaUpDeg * (1.0 - 2.0 * part)}.to_radians().value;
    for (int column = 0; column < width; ++column) {
      const double turn = std::numbers::pi * (1.0 - 2.0 * (column + 0.5) / width);
      const double azimuth = rig.yaw.to_radians().value + turn;
      const Ray ray{rig.position,
                    {std::cos(elevation) * std::cos(azimuth),
                     std::cos(elevation) * std::sin(azimuth), std::sin(elevation)}};
      Hit hit;
      if (!instant.cast(ray, hit)) continue;
      canvas.blend(kMargin + column, top + row, seen(scene, ray, hit), 1.0);
    }
  }
}

}  // namespace

void write_scene_picture(const Scene& scene, Duration since_start,
                         const std::filesystem::path& file) {
  const TopView top_view(scene);
  const int panorama_top = kTitleHeight + top_view.height() + kMargin;
  Canvas canvas(kWidth, panorama_top + kPanoramaHeight + kMargin, replay::theme::kPaper);
  canvas.text({kMargin, kTitleHeight - 10.0}, replay::theme::kHeadingSize, replay::theme::kInk,
              scene.name() + "  " + scene.description());
  const SceneAt instant = scene.at(since_start);
  top_view.draw(scene, instant, canvas);
  draw_panorama(scene, instant, panorama_top, canvas);
  canvas.write_png(file);
}

}  // namespace convexcut::simulation
