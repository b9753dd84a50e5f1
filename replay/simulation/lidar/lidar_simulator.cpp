// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/lidar/lidar_simulator.hpp"

#include <algorithm>
#include <stdexcept>

#include "replay/simulation/stream.hpp"

namespace convexcut::simulation {
namespace {

constexpr double kRangeUnit = 0.002;  // m
constexpr double kSpeckle = 4.0;      // of an intensity of 0 … 100

// Of numbers that are not negative; std::lround is a call.
template <class Integer>
Integer rounded(double number) noexcept {
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): wrong by one at 0.5 − 2⁻⁵⁴, which does not matter
  return static_cast<Integer>(number + 0.5);
}

void require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

const LidarOptions& checked(const LidarOptions& o) {
  require(o.rotor_hz >= 5.0 && o.rotor_hz <= 20.0, "the rotor turns at 5 to 20 Hz");
  require(o.noise_m >= 0.0 && o.noise_m <= 1.0, "the noise of a range is 0 to 1 m");
  require(o.min_range_m >= 0.0 && o.min_range_m < o.max_range_m && o.max_range_m <= 130.0,
          "ranges lie within 0 and 130 m");
  require(o.divergence.value >= 0.0 && o.divergence.value <= 0.05,
          "the divergence of a beam is 0 to 0.05 rad");
  require(o.pulse_length_m > 0.0, "a pulse is longer than 0 m");
  require(o.dropout >= 0.0 && o.dropout <= 1.0 && o.ghosts >= 0.0 && o.ghosts <= 1.0,
          "a share is 0 to 1");
  return o;
}

}  // namespace

LidarSimulator::LidarSimulator(const Scene& scene, const RigMotion& motion,
                               const LidarOptions& options, std::uint64_t seed)
    : options_(checked(options)),
      random_(seed, kLidarStream),
      caster_(scene, motion, options),
      optics_(scene, options),
      beam_(options.divergence) {}

void LidarSimulator::fire(std::uint64_t firing, SimulatedFiring& out) {
  const auto number = static_cast<std::int64_t>(firing);
  look_below_and_above(number - number % kFiringsPerLook);
  // In order: each is cast once, and kept for its neighbours.
  const Column& before = caster_.column(number - 1);
  const Column& own = caster_.column(number);
  const Column& next = caster_.column(number + 1);
  const Neighbourhood around{before, own, next};
  optics_.scatter(own, plain_);
  out.index = firing;
  out.since_start = caster_.time_of(number);
  out.azimuth = caster_.rotor(number);
  for (std::size_t laser = 0; laser < SimulatedFiring::kLasers; ++laser) {
    SimulatedReturn& first = out.returns[0][laser];
    SimulatedReturn& second = out.returns[1][laser];
    first = {};
    if (options_.dual) second = {};
    Random random(random_, firing * SimulatedFiring::kLasers + laser);
    const Chance chance = draw(random);
    if (chance.lost) continue;
    const Sides sides = upright_[laser] | beam_.level_sides(around, laser);
    Echo plain;
    Seen seen;
    if (sides == 0 && plain_.is_plain[laser]) {
      plain = optics_.plain_echo(own, plain_, laser);
      listen(plain, plain_.seen[static_cast<Eigen::Index>(laser)], random, seen);
    } else {
      echoes_.clear();
      beam_.add_echoes(around, laser, sides, optics_, echoes_);
      for (const Echo& pulse : echoes_.all().first(optics_.join(echoes_))) {
        listen(pulse, Optics::seen_probability(pulse.energy), random, seen);
      }
    }
    if (seen.strongest == nullptr) continue;
    // Drawn first, so that a dual-return sensor sees what a single-return one sees, and more.
    const SimulatedReturn strongest = returned(*seen.strongest, chance, random);
    first = strongest;
    if (!options_.dual) continue;
    second = strongest;
    if (seen.second == nullptr) continue;
    if (seen.last == seen.strongest) {
      second = returned(*seen.second, {.speckle = chance.speckle}, random);
    } else {
      first = returned(*seen.last, {.speckle = chance.speckle}, random);
    }
  }
}

void LidarSimulator::look_below_and_above(std::int64_t firing) {
  if (looked_at_ == firing) return;
  looked_at_ = firing;
  upright_ = beam_.upright_sides(caster_.column(firing));
}

LidarSimulator::Chance LidarSimulator::draw(Random& random) const noexcept {
  Chance chance;
  chance.lost = random.chance(options_.dropout);
  if (options_.ghosts > 0.0) {
    chance.ghost = random.chance(options_.ghosts);
    chance.ghost_place = random.uniform();
  } else {
    random.skip(2);
  }
  chance.speckle = random.uniform(-kSpeckle, kSpeckle);
  return chance;
}

void LidarSimulator::listen(const Echo& pulse, double probability, Random& random,
                            Seen& seen) const noexcept {
  if (options_.attenuation && !random.chance(probability)) return;
  if (pulse.range_m < options_.min_range_m || pulse.range_m > options_.max_range_m) return;
  seen.last = &pulse;
  if (seen.strongest == nullptr || pulse.energy > seen.strongest->energy) {
    seen.second = seen.strongest;
    seen.strongest = &pulse;
  } else if (seen.second == nullptr || pulse.energy > seen.second->energy) {
    seen.second = &pulse;
  }
}

SimulatedReturn LidarSimulator::returned(const Echo& echo, const Chance& chance,
                                         Random& random) const noexcept {
  // Of the isolated ghosts four in ten lie before what the beam met, the others behind it.
  double range = echo.range_m;
  if (chance.ghost) {
    range = std::clamp(range * (0.3 + 1.7 * chance.ghost_place), options_.min_range_m,
                       options_.max_range_m);
  }
  const double measured = std::clamp(range + options_.noise_m * random.gaussian(),
                                     options_.min_range_m, options_.max_range_m);
  const double brightness = 100.0 * echo.brightness + chance.speckle;
  SimulatedReturn made;
  made.range_2mm = rounded<std::uint16_t>(measured * (1.0 / kRangeUnit));
  made.true_range_m = static_cast<float>(range);
  made.intensity = rounded<std::uint8_t>(std::clamp(brightness, 1.0, 100.0));
  if (chance.ghost) {
    made.flags = kIsolatedGhost;
    return made;
  }
  made.label = echo.label;
  made.flags = echo.flags;
  made.surface = static_cast<std::uint16_t>(echo.surface);
  return made;
}

}  // namespace convexcut::simulation
