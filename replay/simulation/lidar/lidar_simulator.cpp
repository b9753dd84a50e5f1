// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/lidar/lidar_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "drivers/velodyne/model.hpp"
#include "replay/simulation/stream.hpp"

namespace convexcut::simulation {
namespace {

constexpr double kRangeUnit = 0.002;  // m
constexpr double kFullTurnCentidegrees = 36000.0;

// Where half of the pulses of a surface of reflectivity ρ, seen at a right angle, come back: at
// kHalfRange·√ρ. 40 m for one of 10 %, 113 m for 80 %.
constexpr double kHalfRange = 126.5;

// A neighbour whose hit is farther than this from the plane of one's own says that there may be an
// edge between them.
constexpr double kOffPlane = 0.03;

// The middle of a beam and four places of its rim.
constexpr double kMiddleShare = 0.4;
constexpr double kRimShare = 0.15;

constexpr std::int64_t kOneQ32 = std::int64_t{1} << 32;

void require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

void check(const LidarOptions& o) {
  require(o.rotor_hz >= 5.0 && o.rotor_hz <= 20.0, "the rotor turns at 5 to 20 Hz");
  require(o.noise_m >= 0.0 && o.noise_m <= 1.0, "the noise of a range is 0 to 1 m");
  require(o.min_range_m >= 0.0 && o.min_range_m < o.max_range_m && o.max_range_m <= 130.0,
          "ranges lie within 0 and 130 m");
  require(o.divergence.value >= 0.0 && o.divergence.value <= 0.05,
          "the divergence of a beam is 0 to 0.05 rad");
  require(o.pulse_length_m > 0.0, "a pulse is longer than 0 m");
  require(o.dropout >= 0.0 && o.dropout <= 1.0 && o.ghosts >= 0.0 && o.ghosts <= 1.0,
          "a share is 0 to 1");
}

const Scene& checked(const Scene& scene, const LidarOptions& options) {
  check(options);
  return scene;
}

// A ray from the same place at a small angle to another.
Ray beside(const Ray& ray, const Vec3& aside) {
  Ray other = ray;

  other.direction = (ray.direction + aside).normalized();
  return other;
}

}  // namespace

LidarSimulator::LidarSimulator(const Scene& scene, const RigMotion& motion,
                               const LidarOptions& options, std::uint64_t seed)
    : options_(options),
      seed_(seed),
      motion_(motion),
      optics_(checked(scene, options), options),
      rays_scene_(scene.at(Duration{0})),
      edges_scene_(scene.at(Duration{0})) {
  const velodyne::Model& model = velodyne::model_of(velodyne::ModelId::hdl32e);
  for (std::size_t laser = 0; laser < kLasers; ++laser) {
    const velodyne::SinCos elevation = velodyne::sin_cos(
        Azimuth::from_microdegrees(std::int64_t{model.elevation_mdeg[laser]} * 1000));
    elevation_[laser] = {elevation.cos, elevation.sin};
    share_q32_[laser] =
        (model.laser_time_ns(laser) * kOneQ32 + kFiringPeriod.count() / 2) / kFiringPeriod.count();
    ring_of_laser_[laser] = model.ring[laser];
    laser_of_ring_[model.ring[laser]] = laser;
  }
}

Duration LidarSimulator::time_of(std::int64_t firing) const noexcept {
  return options_.clock.true_time(kFiringPeriod * firing);
}

// The encoder counts hundredths of a degree.
Azimuth LidarSimulator::rotor(std::int64_t firing) const noexcept {
  const double seconds = static_cast<double>(kFiringPeriod.count()) * 1e-9;
  const double turned = options_.rotor_hz * seconds * static_cast<double>(firing);
  return Azimuth::from_centidegrees(
      std::llround(turned * kFullTurnCentidegrees + options_.start_azimuth.value * 100.0));
}

// The rotor moves on as the packet's reader will take it to: by the difference to the packet's next
// azimuth, and after its last one as before it.
std::int64_t LidarSimulator::azimuth_step(std::int64_t firing) const noexcept {
  const std::int64_t per_packet = firings_per_packet();
  const bool last = firing % per_packet == per_packet - 1;
  const std::int64_t from = last ? firing - 1 : firing;
  return rotor(from + 1).clockwise_from(rotor(from));
}

LidarSimulator::Place LidarSimulator::place(std::int64_t firing) {
  const Pose pose = motion_.pose_at(time_of(firing));
  return {pose.position_world, pose.q_world_from_lidar.toRotationMatrix()};
}

const LidarSimulator::Column& LidarSimulator::column(std::int64_t firing) {
  Column& column = columns_[static_cast<std::size_t>((firing + 3) % 3)];
  if (column.known && column.firing == firing) return column;
  column.known = true;
  column.firing = firing;
  aim(firing, column);
  rays_scene_.move_to(time_of(firing));
  for (std::size_t laser = 0; laser < kLasers; ++laser) {
    column.hits[laser] = Hit{};
    column.met[laser] = rays_scene_.cast(column.rays[laser], column.hits[laser]);
  }
  return column;
}

// Between the rig's places at this firing and at the next one everything moves along straight
// lines: 46 µs at 300 °/s leave 1e-8 of that unsaid.
void LidarSimulator::aim(std::int64_t firing, Column& column) {
  const Place begin = placed_firing_ == firing ? placed_ : place(firing);
  placed_ = place(firing + 1);
  placed_firing_ = firing + 1;
  const std::int64_t azimuth = rotor(firing).microdegrees();
  const std::int64_t step = azimuth_step(firing);
  const Vec3 move = placed_.position_world - begin.position_world;
  const Eigen::Matrix3d turn = placed_.world_from_lidar - begin.world_from_lidar;
  for (std::size_t laser = 0; laser < kLasers; ++laser) {
    const std::int64_t turned = (step * share_q32_[laser] + kOneQ32 / 2) >> 32;
    const velodyne::SinCos at = velodyne::sin_cos(Azimuth::from_microdegrees(azimuth + turned));
    const auto [cosine, sine] = elevation_[laser];
    // REP-103: x at azimuth 0, y to the left; the azimuth grows clockwise.
    const Vec3 beam_lidar(cosine * at.cos, -cosine * at.sin, sine);
    const double share = static_cast<double>(share_q32_[laser]) * 0x1p-32;
    column.rays[laser] = {begin.position_world + share * move,
                          begin.world_from_lidar * beam_lidar + share * (turn * beam_lidar)};
  }
}

void LidarSimulator::fire(std::uint64_t firing, SimulatedFiring& out) {
  const auto number = static_cast<std::int64_t>(firing);
  // In order: each is cast once, and kept for its neighbours.
  static_cast<void>(column(number - 1));
  const Column& own = column(number);
  static_cast<void>(column(number + 1));
  out.index = firing;
  out.since_start = time_of(number);
  out.azimuth = rotor(number);
  for (std::size_t laser = 0; laser < kLasers; ++laser) {
    Random random(seed_, kLidarStream, firing * kLasers + laser);
    measure(own, laser, random, out);
  }
}

void LidarSimulator::measure(const Column& column, std::size_t laser, Random& random,
                             SimulatedFiring& out) {
  SimulatedReturn& first = out.returns[0][laser];
  SimulatedReturn& second = out.returns[1][laser];
  first = second = {};
  const bool lost = random.chance(options_.dropout);
  const bool ghost = random.chance(options_.ghosts);
  const double ghost_share = random.uniform();
  const double speckle = random.uniform(-4.0, 4.0);
  if (lost) return;
  gather_echoes(column, laser);
  const std::span<Echo> pulses = echoes_.all().first(optics_.join(echoes_));
  const Echo* strongest = nullptr;
  const Echo* runner_up = nullptr;
  const Echo* last = nullptr;
  for (const Echo& pulse : pulses) {
    const double signal = pulse.energy * kHalfRange * kHalfRange;
    const double seen = signal * signal / (1.0 + signal * signal);
    const bool in_range =
        pulse.range_m >= options_.min_range_m && pulse.range_m <= options_.max_range_m;
    if (options_.attenuation && !random.chance(seen)) continue;
    if (!in_range) continue;
    last = &pulse;
    if (strongest == nullptr || pulse.energy > strongest->energy) {
      runner_up = strongest;
      strongest = &pulse;
    } else if (runner_up == nullptr || pulse.energy > runner_up->energy) {
      runner_up = &pulse;
    }
  }
  if (strongest == nullptr) return;
  const SimulatedReturn best = returned(*strongest, ghost, ghost_share, speckle, random);
  if (!options_.dual) {
    first = best;
    return;
  }
  if (runner_up == nullptr) {
    first = second = best;
    return;
  }
  if (last == strongest) {
    first = best;
    second = returned(*runner_up, false, 0.0, speckle, random);
  } else {
    first = returned(*last, false, 0.0, speckle, random);
    second = best;
  }
}

void LidarSimulator::gather_echoes(const Column& column, std::size_t laser) {
  echoes_.clear();
  if (options_.divergence.value > 0.0 && add_edge(column, laser)) return;
  if (!column.met[laser]) return;
  // The edges' scene is brought here only when light goes on.
  if (!optics_.is_diffuse(column.hits[laser]) && edges_firing_ != column.firing) {
    edges_scene_.move_to(time_of(column.firing));
    edges_firing_ = column.firing;
  }
  optics_.trace(edges_scene_, column.rays[laser], column.hits[laser], 1.0, echoes_);
}

SimulatedReturn LidarSimulator::returned(const Echo& echo, bool ghost, double ghost_share,
                                         double speckle, Random& random) const noexcept {
  // Half of the isolated ghosts and more lie behind what the beam met, the others before it.
  double range = echo.range_m;
  if (ghost) {
    range =
        std::clamp(range * (0.3 + 1.7 * ghost_share), options_.min_range_m, options_.max_range_m);
  }
  const double noisy = std::clamp(range + options_.noise_m * random.gaussian(),
                                  options_.min_range_m, options_.max_range_m);
  const double brightness = 100.0 * echo.brightness + speckle;
  SimulatedReturn made;
  made.range_2mm = static_cast<std::uint16_t>(std::lround(noisy / kRangeUnit));
  made.true_range_m = static_cast<float>(range);
  made.intensity = static_cast<std::uint8_t>(std::clamp(std::lround(brightness), 1L, 100L));
  if (ghost) {
    made.flags = kIsolatedGhost;
    return made;
  }
  made.label = echo.label;
  made.flags = echo.flags;
  made.surface = static_cast<std::uint16_t>(echo.surface);
  return made;
}

// A beam is wider than its middle ray. Where the neighbours met the same plane it does not matter.
// Elsewhere the rim towards them is asked first; only when it differs is the whole beam made of
// five rays. False: the middle ray stands for all.
bool LidarSimulator::add_edge(const Column& column, std::size_t laser) {
  const Ray& ray = column.rays[laser];
  const bool met = column.met[laser];
  const Hit& hit = column.hits[laser];
  const auto same_plane = [&](const Ray& other_ray, bool other_met, const Hit& other) {
    if (other_met != met) return false;
    if (!met) return true;
    if (other.surface != hit.surface) return false;
    const Vec3 apart = other_ray.origin + other.distance_m * other_ray.direction - ray.origin -
                       hit.distance_m * ray.direction;
    return std::abs(hit.normal.dot(apart)) < kOffPlane;
  };
  const std::size_t ring = ring_of_laser_[laser];
  struct Neighbour {
    const Column* column;
    std::size_t laser;
  };
  const std::array<Neighbour, 4> neighbours{
      {{&this->column(column.firing - 1), laser},
       {&this->column(column.firing + 1), laser},
       {&column, ring > 0 ? laser_of_ring_[ring - 1] : laser},
       {&column, ring + 1 < kLasers ? laser_of_ring_[ring + 1] : laser}}};

  struct Rim {
    bool cast = false;
    bool met = false;
    Ray ray;
    Hit hit;
  };
  std::array<Rim, 4> rim{};
  const double radius = 0.5 * options_.divergence.value;
  const auto probe = [&](std::size_t i) {
    // Towards the neighbour; where there is none (the highest and the lowest ring), away from the
    // opposite one.
    const bool has = neighbours[i].column != &column || neighbours[i].laser != laser;
    const Neighbour& towards = neighbours[has ? i : i ^ 1U];
    Vec3 aside = towards.column->rays[towards.laser].direction - ray.direction;
    aside -= aside.dot(ray.direction) * ray.direction;
    aside *= (has ? radius : -radius) / aside.norm();
    Rim& place = rim[i];
    place.cast = true;
    place.ray = beside(ray, aside);
    place.met = edges_scene_.cast(place.ray, place.hit);
  };

  bool edge = false;
  for (std::size_t i = 0; i < neighbours.size() && !edge; ++i) {
    const auto& [beside_column, beside_laser] = neighbours[i];
    if (same_plane(beside_column->rays[beside_laser], beside_column->met[beside_laser],
                   beside_column->hits[beside_laser])) {
      continue;
    }
    if (edges_firing_ != column.firing) {
      edges_scene_.move_to(time_of(column.firing));
      edges_firing_ = column.firing;
    }
    probe(i);
    edge = !same_plane(rim[i].ray, rim[i].met, rim[i].hit);
  }
  if (!edge) return false;
  if (met) optics_.trace(edges_scene_, ray, hit, kMiddleShare, echoes_);
  for (std::size_t i = 0; i < rim.size(); ++i) {
    if (!rim[i].cast) probe(i);
    if (rim[i].met) optics_.trace(edges_scene_, rim[i].ray, rim[i].hit, kRimShare, echoes_);
  }
  return true;
}

}  // namespace convexcut::simulation
