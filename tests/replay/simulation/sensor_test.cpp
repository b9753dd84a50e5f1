// SPDX-License-Identifier: Apache-2.0
//
// What the simulated lidar gets wrong, one effect at a time, by statistics with fixed seeds. Not
// proved: that a real HDL-32E has these figures (they come from its manual, from data sheets of its
// class and from optics, see docs/design/simulator.md).
#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/velodyne/model.hpp"
#include "replay/simulation/lidar/lidar_simulator.hpp"
#include "replay/simulation/simulation.hpp"
#include "tests/replay/simulation/scenes.hpp"

namespace convexcut::simulation {
namespace {

using test::empty_room;
using test::empty_room_text;
using test::kLidar;
using test::kRoom;
using test::room_of;
using test::scene_of;
using test::to_side;

constexpr std::uint64_t kRevolution = 2170;  // firings at 10 Hz

// Sees what is there, and nothing else.
LidarOptions perfect() {
  LidarOptions options;
  options.start_azimuth = Degrees{0.0};
  options.noise_m = 0.0;
  options.divergence = {0.0};
  options.dropout = 0.0;
  options.attenuation = false;
  return options;
}

struct Shot {
  const SimulatedReturn& first;
  const SimulatedReturn& second;
  Vec3 direction_lidar;
  std::uint64_t firing;
  std::size_t laser;
};

// The lidar stands upright and still, its x along the world's: both frames have the same axes.
void for_each_shot(const Scene& scene, const LidarOptions& options, std::uint64_t firings,
                   const std::function<void(const Shot&)>& use, std::uint64_t seed = 3) {
  const RigMotion motion(planned_rig(scene, false), seed);
  LidarSimulator lidar(scene, motion, options, seed);
  const velodyne::Model& model = velodyne::model_of(velodyne::ModelId::hdl32e);
  SimulatedFiring firing;
  for (std::uint64_t i = 0; i < firings; ++i) {
    lidar.fire(i, firing);
    for (std::size_t laser = 0; laser < SimulatedFiring::kLasers; ++laser) {
      // Within 0.02°, the encoder's steps; the rotor turns by 3600 °/s.
      const double azimuth =
          Degrees{firing.azimuth.degrees().value + 3600.0 * 1.152e-6 * static_cast<double>(laser)}
              .to_radians()
              .value;
      const double elevation = Degrees{model.elevation_mdeg[laser] * 1e-3}.to_radians().value;
      use({firing.returns[0][laser], firing.returns[1][laser],
           Vec3(std::cos(elevation) * std::cos(azimuth), -std::cos(elevation) * std::sin(azimuth),
                std::sin(elevation)),
           i, laser});
    }
  }
}

TEST(Sensor, RangesScatterByTheNoiseAndComeInSteps) {
  LidarOptions options = perfect();
  options.noise_m = 0.02;
  double sum = 0;
  double squares = 0;
  double n = 0;
  for_each_shot(empty_room(), options, kRevolution, [&](const Shot& shot) {
    const double off = shot.first.range_2mm * 0.002 - static_cast<double>(shot.first.true_range_m);
    sum += off;
    squares += off * off;
    n += 1;
  });
  ASSERT_EQ(n, kRevolution * 32.0);
  EXPECT_NEAR(sum / n, 0.0, 4 * 0.02 / std::sqrt(n));
  // The rounding to 2 mm adds 0.6 mm, root mean square.
  EXPECT_NEAR(std::sqrt(squares / n), std::hypot(0.02, 0.002 / std::sqrt(12.0)),
              4 * 0.02 / std::sqrt(2 * n));
}

TEST(Sensor, WithoutNoiseARangeIsRoundedToItsStep) {
  for_each_shot(empty_room(), perfect(), 200, [](const Shot& shot) {
    ASSERT_NEAR(shot.first.range_2mm * 0.002, static_cast<double>(shot.first.true_range_m),
                0.0010001);
    ASSERT_EQ(shot.first.label, SurfaceLabel::structure);
    ASSERT_EQ(shot.first.flags, 0);
  });
}

TEST(Sensor, IsolatedGhostsAreTheirShareAndLieBeforeAndBehind) {
  LidarOptions options = perfect();
  options.ghosts = 0.01;
  double ghosts = 0;
  double behind = 0;
  for_each_shot(empty_room(), options, kRevolution, [&](const Shot& shot) {
    if ((shot.first.flags & kIsolatedGhost) == 0) return;
    ASSERT_EQ(shot.first.label, SurfaceLabel::none);
    ASSERT_EQ(shot.first.surface, kNoSurface);
    ghosts += 1;
    const double wall = to_side(kLidar, shot.direction_lidar, {0, 0, 0}, kRoom);
    behind += static_cast<double>(shot.first.true_range_m) > wall ? 1 : 0;
  });
  const double shots = kRevolution * 32.0;
  EXPECT_NEAR(ghosts / shots, 0.01, 4 * std::sqrt(0.01 * 0.99 / shots));
  EXPECT_NEAR(behind / ghosts, 1.0 / 1.7, 4 * std::sqrt(0.25 / ghosts));
}

TEST(Sensor, DropoutsAreTheirShare) {
  LidarOptions options = perfect();
  options.dropout = 0.05;
  double lost = 0;
  for_each_shot(empty_room(), options, kRevolution,
                [&](const Shot& shot) { lost += shot.first.range_2mm == 0 ? 1 : 0; });
  const double shots = kRevolution * 32.0;
  EXPECT_NEAR(lost / shots, 0.05, 4 * std::sqrt(0.05 * 0.95 / shots));
}

// Of a long dark hall, by the part of its length that a return is of: near, far.
struct Losses {
  double near = 0;
  double far = 0;
};
Losses losses_in_hall(double reflectivity) {
  const Scene scene = scene_of(room_of({90, 10, 8}, {2, 5, 2}, reflectivity));
  LidarOptions options = perfect();
  options.attenuation = true;
  double shots_near = 0;
  double shots_far = 0;
  Losses losses;
  for_each_shot(scene, options, kRevolution, [&](const Shot& shot) {
    const double range = to_side({2, 5, 2}, shot.direction_lidar, {0, 0, 0}, {90, 10, 8});
    (range < 8 ? shots_near : shots_far) += 1;
    if (shot.first.range_2mm == 0) (range < 8 ? losses.near : losses.far) += 1;
  });
  losses.near /= shots_near;
  losses.far /= shots_far;
  return losses;
}

TEST(Sensor, WhatIsDarkFarOrMetOnASlantIsLostMoreOften) {
  const Losses bright = losses_in_hall(0.8);
  const Losses dark = losses_in_hall(0.05);
  EXPECT_LT(bright.near, 0.002);
  EXPECT_LT(dark.near, 0.01);
  EXPECT_GT(bright.far, 5 * bright.near);
  EXPECT_GT(dark.far, 3 * bright.far);
  EXPECT_GT(dark.far, 0.2);
}

TEST(Sensor, NothingIsSeenNearerThanTheLeastRangeOrFartherThanTheMost) {
  LidarOptions options = perfect();
  options.min_range_m = 2.5;
  options.max_range_m = 4.0;
  std::size_t seen = 0;
  std::size_t hidden = 0;
  for_each_shot(empty_room(), options, kRevolution, [&](const Shot& shot) {
    const double range = to_side(kLidar, shot.direction_lidar, {0, 0, 0}, kRoom);
    if (range > 2.55 && range < 3.95) {
      ASSERT_NE(shot.first.range_2mm, 0);
      ++seen;
    } else if (range < 2.45 || range > 4.05) {
      ASSERT_EQ(shot.first.range_2mm, 0);
      ++hidden;
    }
  });
  EXPECT_GT(seen, 10'000U);
  EXPECT_GT(hidden, 10'000U);
}

// The east wall (x = 8) is a mirror.
std::string with_wall(const std::string& material, double reflectivity) {
  return empty_room_text() + R"(
[[rectangle]]
name = "pane"
label = "object"
corner = [7.999, 1.0, 0.5]
u = [0, 4, 0]
v = [0, 0, 2]
material = ")" +
         material + "\"\nreflectivity = " + std::to_string(reflectivity) + "\n";
}

TEST(Sensor, AMirrorShowsTheRoomBehindItself) {
  const Scene scene = scene_of(with_wall("mirror", 0.0));
  std::size_t ghosts = 0;
  for_each_shot(scene, perfect(), kRevolution, [&](const Shot& shot) {
    const Vec3& lidar = kLidar;
    const double wall = (7.999 - lidar.x()) / shot.direction_lidar.x();
    const Vec3 at = lidar + wall * shot.direction_lidar;
    const bool in_mirror =
        wall > 0 && at.y() > 1.05 && at.y() < 4.95 && at.z() > 0.55 && at.z() < 2.45;
    if (!in_mirror) return;
    // All but the one ray that comes straight back.
    if (std::abs(shot.direction_lidar.y()) < 0.02 && std::abs(shot.direction_lidar.z()) < 0.02) {
      return;
    }
    ++ghosts;
    ASSERT_EQ(shot.first.flags, kSpecularGhost);
    ASSERT_EQ(shot.first.label, SurfaceLabel::none);
    ASSERT_EQ(scene.surfaces()[shot.first.surface].name, "pane");
    // The image of the room, x from 7.999 to 15.998: the path goes on as if straight.
    const double image = to_side(lidar, shot.direction_lidar, {0, 0, 0}, {15.998, 6, 3});
    ASSERT_NEAR(shot.first.true_range_m, image, 0.06);
  });
  EXPECT_GT(ghosts, 3'000U);
}

TEST(Sensor, GlassIsSeenThroughAndMirrorsALittle) {
  const Scene scene = scene_of(room_of({12, 6, 3}, kLidar, 0.6) + R"(
[[rectangle]]
name = "pane"
label = "structure"
corner = [8.0, 0.0, 0.0]
u = [0, 6, 0]
v = [0, 0, 3]
material = "glass"
reflectivity = 0.02
)");
  const Vec3& lidar = kLidar;
  for (const bool dual : {false, true}) {
    LidarOptions options = perfect();
    options.dual = dual;
    options.attenuation = true;
    double shots = 0;
    double through = 0;
    double pane = 0;
    double ghosts = 0;
    for_each_shot(scene, options, kRevolution, [&](const Shot& shot) {
      const double at_pane = (8.0 - lidar.x()) / shot.direction_lidar.x();
      const double straight = to_side(lidar, shot.direction_lidar, {0, 0, 0}, {12, 6, 3});
      if (at_pane < 0 || at_pane > straight - 0.6) return;
      shots += 1;
      for (const SimulatedReturn* r : {&shot.first, &shot.second}) {
        ghosts += (r->flags & kSpecularGhost) != 0 ? 1 : 0;
        pane += r->range_2mm != 0 && r->flags == 0 ? 1 : 0;
        if ((r->flags & kThroughGlass) == 0) continue;
        ASSERT_NEAR(r->true_range_m, straight, 0.06);
        ASSERT_EQ(r->label, SurfaceLabel::structure);
        through += 1;
      }
    });
    ASSERT_GT(shots, 5'000);
    // The strongest is the wall behind, but where the pane is met on a slant. The other one of two
    // is the pane itself, or this side of the room mirrored in it, which is fainter than both.
    EXPECT_GT(through, shots * 0.8);
    EXPECT_LE(through, shots);
    EXPECT_LT(ghosts, shots * 0.2);
    if (dual) {
      EXPECT_GT(pane, shots * 0.2);
      EXPECT_GT(ghosts, shots * 0.01);
    } else {
      EXPECT_LT(pane, shots * 0.1);
    }
  }
}

// A post before the wall: 0.3 m or 3 m before it.
std::string with_post(double before_wall) {
  const double x = 8.0 - before_wall;
  return empty_room_text() + "[[box]]\nname = \"post\"\nlabel = \"object\"\nmin = [" +
         std::to_string(x - 0.1) + ", 1.5, 0.0]\nmax = [" + std::to_string(x) +
         ", 2.5, 3.0]\nreflectivity = 0.6\n";
}

struct Edges {
  std::size_t mixed = 0;
  std::size_t in_the_air = 0;
};
Edges edges_of(const Scene& scene, const LidarOptions& options) {
  Edges edges;
  for_each_shot(scene, options, kRevolution, [&](const Shot& shot) {
    if ((shot.first.flags & kMixedPixel) == 0) return;
    ++edges.mixed;
    edges.in_the_air += shot.first.label == SurfaceLabel::none ? 1U : 0U;
  });
  return edges;
}

TEST(Sensor, ABeamOnAnEdgeIsSeenBetweenTheTwoSurfacesWhenTheyAreNear) {
  LidarOptions options = perfect();
  EXPECT_EQ(edges_of(scene_of(with_post(0.3)), options).mixed, 0U);  // a beam without width
  options.divergence = {0.003};
  const Edges near = edges_of(scene_of(with_post(0.3)), options);
  const Edges far = edges_of(scene_of(with_post(3.0)), options);
  // Two upright edges, 32 lasers, one shot each; at some the parts are as good as equal.
  EXPECT_GT(near.in_the_air, 20U);
  EXPECT_LT(near.in_the_air, 200U);
  // Pulses 3 m apart are told apart; only close to the floor something nearer is behind the post.
  EXPECT_LT(far.in_the_air, near.in_the_air / 4);
}

TEST(Sensor, DualReturnHasBothSurfacesOfAnEdge) {
  LidarOptions options = perfect();
  options.divergence = {0.003};
  options.dual = true;
  std::size_t both = 0;
  for_each_shot(scene_of(with_post(3.0)), options, kRevolution, [&](const Shot& shot) {
    if (shot.first.range_2mm == shot.second.range_2mm) return;
    ASSERT_GT(shot.first.range_2mm, shot.second.range_2mm);  // the last comes first
    ++both;
  });
  EXPECT_GT(both, 20U);
  EXPECT_LT(both, 200U);
}

TEST(Sensor, AFiringDoesNotDependOnWhatWasAskedBefore) {
  const Scene scene = Scene::named("office");
  const RigMotion motion(planned_rig(scene, false), 1);
  LidarSimulator in_order(scene, motion, {}, 1);
  LidarSimulator at_once(scene, motion, {}, 1);
  SimulatedFiring a;
  SimulatedFiring b;
  for (std::uint64_t i = 0; i <= 97; ++i) in_order.fire(i, a);
  at_once.fire(97, b);
  for (std::size_t laser = 0; laser < SimulatedFiring::kLasers; ++laser) {
    EXPECT_EQ(a.returns[0][laser].range_2mm, b.returns[0][laser].range_2mm);
    EXPECT_EQ(a.returns[0][laser].true_range_m, b.returns[0][laser].true_range_m);
    EXPECT_EQ(a.returns[0][laser].surface, b.returns[0][laser].surface);
  }
}

TEST(Sensor, OptionsOutOfTheirRangeAreRefused) {
  const Scene scene = empty_room();
  const RigMotion motion(planned_rig(scene, false), 1);
  for (const auto& wrong : std::vector<std::function<void(LidarOptions&)>>{
           [](LidarOptions& o) { o.rotor_hz = 30.0; }, [](LidarOptions& o) { o.noise_m = -0.1; },
           [](LidarOptions& o) { o.min_range_m = 200.0; },
           [](LidarOptions& o) { o.divergence = {1.0}; }, [](LidarOptions& o) { o.ghosts = 1.5; },
           [](LidarOptions& o) { o.pulse_length_m = 0.0; }}) {
    LidarOptions options;
    wrong(options);
    EXPECT_THROW(LidarSimulator(scene, motion, options, 1), std::invalid_argument);
  }
}

}  // namespace
}  // namespace convexcut::simulation
