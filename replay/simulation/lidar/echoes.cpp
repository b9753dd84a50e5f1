// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/lidar/echoes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "replay/simulation/lidar/simulated_firing.hpp"

namespace convexcut::simulation {
namespace {

constexpr int kMostTurns = 3;
constexpr double kFaintest = 1e-4;  // share of a pulse's energy that is not worth following

// A pane reflects at both of its faces: 4 % each at a right angle, all of it at a grazing one
// (C. Schlick, "An inexpensive BRDF model for physically-based rendering", 1994), and swallows 5 %.
constexpr double kPaneReflectance = 0.08;
constexpr double kPaneAbsorption = 0.05;
constexpr double kMirrorReflectance = 0.9;
// Seen at a right angle, within the lens, it shines back by itself.
constexpr double kGlintCosine = 0.99998;  // 0.36°

double reflectance(Material material, double cosine) noexcept {
  if (material == Material::mirror) return kMirrorReflectance;
  const double slant = 1.0 - cosine;
  const double slant2 = slant * slant;
  return kPaneReflectance + (1.0 - kPaneReflectance) * slant2 * slant2 * slant;
}

// These three take a number, or an array of them; the results are the same.

// A diffuse surface scatters like Lambert's; a beam that meets it on a slant comes back as a longer
// pulse with a lower peak. `stretched`: the length of that pulse over its own, along the surface.
template <class Number>
Number peak_of(const Number& cosine, const Number& stretched) noexcept {
  using std::sqrt;
  const Number cosine2 = cosine * cosine;
  return cosine2 / sqrt(cosine2 + stretched * stretched * (1.0 - cosine2));
}

template <class Number>
Number brightness_of(const Number& reflectivity, const Number& cosine) noexcept {
  return reflectivity * (0.3 + 0.7 * cosine);
}

// Where half of the pulses of a surface of reflectivity ρ, seen at a right angle, come back: at
// kHalfRange·√ρ. 40 m for one of 10 %, 113 m for 80 %.
constexpr double kHalfRange = 126.5;

template <class Number>
Number probability_of(const Number& energy) noexcept {
  const Number signal = energy * (kHalfRange * kHalfRange);
  return signal * signal / (1.0 + signal * signal);
}

double cosine_of(const Ray& ray, const Hit& hit) noexcept {
  return std::min(std::abs(ray.direction.dot(hit.normal)), 1.0);
}

// Where pulses of different ranges were joined: the surface that the range is on, if any.
constexpr double kOnSurface = 0.05;

void settle_truth(std::span<const Echo> group, Echo& pulse) noexcept {
  if (group.size() == 1) return;
  const auto after = std::find_if(group.begin(), group.end(),
                                  [&](const Echo& echo) { return echo.range_m > pulse.range_m; });
  const Echo& far = after == group.end() ? group.back() : *after;
  const Echo& near = after == group.begin() ? group.front() : *(after - 1);
  const bool nearer = pulse.range_m - near.range_m < far.range_m - pulse.range_m;
  const Echo& nearest = nearer ? near : far;
  pulse.surface = nearest.surface;
  pulse.label = nearest.label;
  pulse.flags = nearest.flags;
  if (group.back().range_m - group.front().range_m <= kOnSurface) return;
  pulse.flags |= kMixedPixel;
  const bool in_the_air = std::abs(nearest.range_m - pulse.range_m) > kOnSurface;
  if (!in_the_air || near.surface == far.surface) return;
  pulse.surface = kNoSurface;
  pulse.label = SurfaceLabel::none;
}

Echo joined(std::span<const Echo> group) noexcept {
  Echo sum = group.front();
  sum.range_m = sum.energy = sum.brightness = 0.0;
  for (const Echo& echo : group) {
    sum.energy += echo.energy;
    sum.range_m += echo.energy * echo.range_m;
    sum.brightness += echo.energy * echo.brightness;
  }
  sum.range_m /= sum.energy;
  sum.brightness /= sum.energy;
  settle_truth(group, sum);
  return sum;
}

}  // namespace

Optics::Optics(const Scene& scene, const LidarOptions& options)
    : surfaces_(scene.surfaces()),
      scene_(scene),
      stretch_(options.divergence.value / options.pulse_length_m),
      pulse_length_m_(options.pulse_length_m) {}

void Optics::trace(const Surroundings& around, std::size_t laser, const Ray& ray, const Hit& hit,
                   double weight, Echoes& echoes) const noexcept {
  follow(around, ray, hit, {.energy = weight, .laser = laser}, echoes);
}

void Optics::scatter(const Column& column, PlainEchoes& out) const noexcept {
  using Numbers = PlainEchoes::Numbers;
  Numbers range = Numbers::Ones();
  Numbers cosine = Numbers::Ones();
  Numbers reflectivity = Numbers::Zero();
  for (std::size_t laser = 0; laser < Column::kLasers; ++laser) {
    const Hit& hit = column.hits[laser];
    out.is_plain[laser] = column.met[laser] && surfaces_[hit.surface].material == Material::diffuse;
    if (!out.is_plain[laser]) continue;
    const auto i = static_cast<Eigen::Index>(laser);
    range[i] = hit.distance_m;
    cosine[i] = cosine_of(column.rays[laser], hit);
    reflectivity[i] = surfaces_[hit.surface].reflectivity;
  }
  const Numbers stretched = range * stretch_;
  out.energy = reflectivity * peak_of(cosine, stretched) / (range * range);
  out.brightness = brightness_of(reflectivity, cosine);
  out.seen = probability_of(out.energy);
}

double Optics::seen_probability(double energy) noexcept { return probability_of(energy); }

Echo Optics::scattered(const Hit& hit, double cosine, const Light& light) const noexcept {
  const SurfaceInfo& surface = surfaces_[hit.surface];
  const double range = light.travelled_m + hit.distance_m;
  const double peak = peak_of(cosine, range * stretch_);
  Echo echo{.range_m = range,
            .energy = light.energy * surface.reflectivity * peak / (range * range),
            .brightness = brightness_of(surface.reflectivity, cosine),
            .surface = hit.surface,
            .label = surface.label,
            .flags = light.flags};
  if (light.mirror != kNoSurface) {
    echo.surface = light.mirror;
    echo.label = SurfaceLabel::none;
  }
  return echo;
}

void Optics::follow(const Surroundings& around, const Ray& ray, const Hit& hit, const Light& light,
                    Echoes& echoes) const noexcept {
  const SurfaceInfo& surface = surfaces_[hit.surface];
  const double cosine = cosine_of(ray, hit);
  Echo echo = scattered(hit, cosine, light);
  if (surface.material == Material::diffuse) {
    if (echo.energy > 0.0) echoes.add(echo);
    return;
  }
  const double mirrored_share = reflectance(surface.material, cosine);
  if (cosine > kGlintCosine) {
    echo.energy += light.energy * mirrored_share / (echo.range_m * echo.range_m);
    echo.brightness = 1.0;
  }
  if (echo.energy > 0.0) echoes.add(echo);
  if (light.turns == kMostTurns) return;

  if (surface.material == Material::glass) {
    const double through = (1.0 - mirrored_share) * (1.0 - kPaneAbsorption);
    Light beyond = light;
    beyond.energy *= through * through;
    beyond.turns += 1;
    if (light.mirror == kNoSurface) beyond.flags |= kThroughGlass;
    Ray on = ray;
    on.min_distance_m = hit.distance_m + kBehindSurface;
    cast_on(around, on, beyond, echoes);
  }
  Light reflected = light;
  reflected.travelled_m += hit.distance_m;
  reflected.energy *= mirrored_share * mirrored_share;
  reflected.turns += 1;
  reflected.flags = kSpecularGhost;
  if (light.mirror == kNoSurface) reflected.mirror = hit.surface;
  cast_on(around, mirrored(ray, hit), reflected, echoes);
}

void Optics::cast_on(const Surroundings& around, const Ray& ray, const Light& light,
                     Echoes& echoes) const noexcept {
  if (light.energy < kFaintest) return;
  Hit hit;
  const bool straight = light.mirror == kNoSurface;
  if (!(straight ? around.cast(light.laser, ray, hit) : around.cast(ray, hit))) return;
  follow(around, ray, hit, light, echoes);
}

std::size_t Optics::join(Echoes& echoes) const noexcept {
  const std::span<Echo> all = echoes.all();
  if (all.size() < 2) return all.size();
  for (std::size_t i = 1; i < all.size(); ++i) {  // few, and mostly in order
    for (std::size_t k = i; k > 0 && all[k].range_m < all[k - 1].range_m; --k) {
      std::swap(all[k], all[k - 1]);
    }
  }
  std::size_t pulses = 0;
  for (std::size_t first = 0; first < all.size();) {
    std::size_t last = first + 1;
    while (last < all.size() && all[last].range_m - all[first].range_m <= pulse_length_m_) ++last;
    all[pulses++] = joined(all.subspan(first, last - first));
    first = last;
  }
  return pulses;
}

}  // namespace convexcut::simulation
