// SPDX-License-Identifier: Apache-2.0
#include "tests/core/convex_cut/clouds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace convexcut::test {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

Cloud uniform_box(Random& random) {
  Cloud cloud;
  for (int i = 0; i < 1500; ++i) {
    cloud.add(random.uniform(-5, 5), random.uniform(-4, 4), random.uniform(-1, 2));
  }
  return cloud;
}

Cloud noisy_walls(Random& random) {
  Cloud cloud;
  for (int i = 0; i < 2000; ++i) {
    std::array<double, 3> p{random.uniform(-5, 5), random.uniform(-4, 4), random.uniform(-1, 2)};
    constexpr std::array<std::array<double, 2>, 3> kWalls{{{-5, 5}, {-4, 4}, {-1, 2}}};
    const std::size_t axis = random.index(3);
    p.at(axis) = kWalls.at(axis).at(random.index(2)) + 0.02 * random.normal();
    cloud.add(p[0], p[1], p[2]);
  }
  return cloud;
}

Cloud room(Random& random) { return furnished_room(random, 2500); }

Cloud on_one_line(Random& random) {
  // Dyadic multiples of one vector: collinear exactly, through the axis or beside it.
  const double beside = random.index(2) == 0 ? 0.0 : 0.5;
  Cloud cloud;
  for (int i = 0; i < 300; ++i) {
    const double t = std::floor(random.uniform(-64, 64)) / 16.0;
    cloud.add(t, 0.5 * t + beside, 0.25 * t);
  }
  return cloud;
}

Cloud vertical_line(Random& random) {
  Cloud cloud;
  const double x = random.uniform(-3, 3);
  for (int i = 0; i < 200; ++i) cloud.add(x, 1.0, random.uniform(-1, 2));
  return cloud;
}

Cloud few_places(Random& random) {
  std::array<std::array<double, 3>, 12> places;
  for (auto& place : places) {
    place = {random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-1, 1)};
  }
  Cloud cloud;
  for (int i = 0; i < 600; ++i) {
    const auto& place = places.at(random.index(places.size()));
    cloud.add(place[0], place[1], place[2]);
  }
  return cloud;
}

Cloud two_directions(Random& random) {  // most slices stay empty
  Cloud cloud;
  for (int i = 0; i < 800; ++i) {
    const double angle = (random.index(2) == 0 ? 0.4 : 2.9) + random.uniform(-0.03, 0.03);
    const double r = random.uniform(1, 9);
    cloud.add(r * std::cos(angle), r * std::sin(angle), random.uniform(-1, 2));
  }
  return cloud;
}

Cloud on_the_axis(Random& random) {
  Cloud cloud;
  for (int i = 0; i < 400; ++i) cloud.add(0, 0, random.uniform(-1, 2));
  return cloud;
}

Cloud on_the_axis_but_one(Random& random) {  // by less than an extreme is resolved to
  Cloud cloud = on_the_axis(random);
  for (std::size_t i = 0; i < 2; ++i) cloud.x[random.index(cloud.size())] = 1e-5F;
  return cloud;
}

Cloud in_one_place(Random& random) {
  Cloud cloud;
  const double x = random.uniform(-0.1, 0.1);
  for (int i = 0; i < 100; ++i) cloud.add(x, 0.01, 1.5);
  return cloud;
}

Cloud near_the_axis(Random& random) {  // within the half width of every plane, or just outside
  Cloud cloud;
  for (int i = 0; i < 600; ++i) {
    cloud.add(0.06 * random.normal(), 0.06 * random.normal(), random.uniform(-1, 2));
  }
  return cloud;
}

Cloud lattice(Random& random) {  // ties of every kind, and |v| = d, distance = e for dyadic d, e
  Cloud cloud;
  const auto step = [&] { return std::floor(random.uniform(-12, 13)) / 4.0; };
  for (int i = 0; i < 1500; ++i) {
    const double x = step();
    const double y = step();
    cloud.add(x, y, step());
  }
  return cloud;
}

Cloud far_clusters(Random& random) {
  Cloud cloud;
  for (int cluster = 0; cluster < 12; ++cluster) {
    const double angle = random.uniform(0, kTurn);
    const double r = random.uniform(90, 131);
    const double z = random.uniform(-20, 20);
    for (int i = 0; i < 120; ++i) {
      cloud.add(r * std::cos(angle) + random.normal(), r * std::sin(angle) + random.normal(),
                z + random.normal());
    }
  }
  return cloud;
}

Cloud up_to_five_points(Random& random) {
  Cloud cloud;
  const std::size_t count = random.index(6);
  for (std::size_t i = 0; i < count; ++i) {
    cloud.add(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  }
  return cloud;
}

Cloud sphere(Random& random) {  // round hulls with very many vertices
  Cloud cloud;
  for (int i = 0; i < 2500; ++i) {
    const double z = random.uniform(-1, 1);
    const double angle = random.uniform(0, kTurn);
    const double r = std::sqrt(1.0 - z * z);
    cloud.add(5 * r * std::cos(angle), 5 * r * std::sin(angle), 5 * z);
  }
  return cloud;
}

Cloud one_height(Random& random) {  // every hull is degenerate
  Cloud cloud;
  for (int i = 0; i < 700; ++i) cloud.add(random.uniform(-5, 5), random.uniform(-5, 5), -1.25);
  return cloud;
}

Cloud at_the_hull_distance(Random& random) {
  // Walls at u ≈ ±4 and points a few float steps about 0.08 m inside of them.
  Cloud cloud;
  for (int i = 0; i < 1500; ++i) {
    const double angle = random.uniform(0, kTurn);
    const double inside = random.index(2) == 0 ? 0.0 : 0.08 + 1e-7 * random.normal();
    cloud.add((4.0 - inside) * std::cos(angle), (4.0 - inside) * std::sin(angle),
              random.uniform(-1, 2));
  }
  return cloud;
}

Cloud dense(Random& random) {  // slices of thousands of points
  Cloud cloud;
  for (int i = 0; i < 9000; ++i) {
    cloud.add(random.normal(), random.normal(), random.normal());
  }
  return cloud;
}

Cloud all_magnitudes(Random& random) {  // from the least float to the greatest that is allowed
  Cloud cloud;
  const auto any = [&] {
    const double magnitude = std::exp2(random.uniform(-149, 19.9));
    return random.index(2) == 0 ? magnitude : -magnitude;
  };
  for (int i = 0; i < 800; ++i) {
    const double x = any();
    const double y = any();
    cloud.add(x, y, any());
  }
  return cloud;
}

}  // namespace

double Random::normal() {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += uniform(0.0, 1.0);
  return sum;
}

const std::vector<Distribution>& distributions() {
  static const std::vector<Distribution> kAll{
      {"uniform_box", uniform_box},
      {"noisy_walls", noisy_walls},
      {"room", room},
      {"on_one_line", on_one_line},
      {"vertical_line", vertical_line},
      {"few_places", few_places},
      {"two_directions", two_directions},
      {"on_the_axis", on_the_axis},
      {"on_the_axis_but_one", on_the_axis_but_one},
      {"in_one_place", in_one_place},
      {"near_the_axis", near_the_axis},
      {"lattice", lattice},
      {"far_clusters", far_clusters},
      {"up_to_five_points", up_to_five_points},
      {"sphere", sphere},
      {"one_height", one_height},
      {"at_the_hull_distance", at_the_hull_distance},
      {"dense", dense},
      {"all_magnitudes", all_magnitudes},
  };
  return kAll;
}

Cloud furnished_room(Random& random, std::size_t points) {
  struct Box {
    std::array<double, 3> low, high;
  };
  constexpr Box kRoom{{-3.8, -2.9, -1.1}, {4.2, 3.1, 1.6}};
  constexpr std::array<Box, 3> kFurniture{{{{1.4, 0.9, -1.1}, {2.3, 1.9, -0.3}},
                                           {{-2.6, -2.7, -1.1}, {-1.2, -2.2, 0.8}},
                                           {{-1.9, 1.2, -1.1}, {-1.5, 1.6, 0.6}}}};
  Cloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    const double angle = random.uniform(0, kTurn);
    const double elevation = random.uniform(-0.53, 0.19);
    const std::array<double, 3> ray{std::cos(elevation) * std::cos(angle),
                                    std::cos(elevation) * std::sin(angle), std::sin(elevation)};
    const auto cross = [&](const Box& box) {
      std::array<double, 2> t{-1e9, 1e9};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double a = box.low.at(axis) / ray.at(axis);
        const double b = box.high.at(axis) / ray.at(axis);
        t = {std::max(t[0], std::min(a, b)), std::min(t[1], std::max(a, b))};
      }
      return t;
    };
    double range = cross(kRoom)[1];
    for (const Box& box : kFurniture) {
      const auto [enter, leave] = cross(box);
      if (enter > 0 && enter < leave) range = std::min(range, enter);
    }
    range += 0.02 * random.normal();
    cloud.add(range * ray[0], range * ray[1], range * ray[2]);
  }
  return cloud;
}

}  // namespace convexcut::test
