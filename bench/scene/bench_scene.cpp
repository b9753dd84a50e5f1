// SPDX-License-Identifier: Apache-2.0
//
// Time of SceneAt::cast in each shipped scene: all shots of one revolution of an upright HDL-32E at
// the rig's start, in the order of firing, the movers moved once a packet; and of move_to alone.
//   bench_scene [--benchmark_filter=office]
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "replay/simulation/scene/scene.hpp"

namespace convexcut::simulation {
namespace {

constexpr std::size_t kLasers = 32;
constexpr std::size_t kColumns = 2170;
constexpr std::size_t kColumnsPerPacket = 12;
constexpr Duration kPacket = std::chrono::nanoseconds{552'960};

std::vector<Vec3> column_directions(std::size_t column) {
  std::vector<Vec3> directions;
  const double azimuth = -2.0 * std::numbers::pi * static_cast<double>(column) / kColumns;
  for (std::size_t laser = 0; laser < kLasers; ++laser) {
    const double elevation =
        Degrees{-30.67 + static_cast<double>(laser) * 4.0 / 3.0}.to_radians().value;
    directions.emplace_back(std::cos(elevation) * std::cos(azimuth),
                            std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  }
  return directions;
}

void cast_revolution(benchmark::State& state, const Scene& scene) {
  std::vector<std::vector<Vec3>> columns;
  for (std::size_t i = 0; i < kColumns; ++i) columns.push_back(column_directions(i));
  SceneAt instant = scene.at(Duration{});
  const Vec3 origin = scene.rig().position;
  std::int64_t packets = 0;
  for (auto _ : state) {
    for (std::size_t i = 0; i < kColumns; ++i) {
      if (i % kColumnsPerPacket == 0) instant.move_to(packets++ * kPacket);
      for (const Vec3& direction : columns[i]) {
        Hit hit;
        benchmark::DoNotOptimize(instant.cast({origin, direction}, hit));
        benchmark::DoNotOptimize(hit);
      }
    }
  }
  constexpr double kShots = static_cast<double>(kColumns * kLasers);
  using benchmark::Counter;
  state.counters["a_cast"] = Counter(kShots, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["surfaces"] = static_cast<double>(scene.surfaces().size());
}

void move(benchmark::State& state, const Scene& scene) {
  SceneAt instant = scene.at(Duration{});
  std::int64_t packets = 0;
  for (auto _ : state) instant.move_to(packets++ * kPacket);
}

void add(const std::string& name, const Scene& scene) {
  benchmark::RegisterBenchmark(("cast/" + name).c_str(), cast_revolution, scene)
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark(("move_to/" + name).c_str(), move, scene);
}

}  // namespace
}  // namespace convexcut::simulation

int main(int argc, char** argv) {
  using convexcut::simulation::Scene;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  for (const std::string_view name : Scene::names()) {
    convexcut::simulation::add(std::string(name), Scene::named(name));
  }
  convexcut::simulation::add("office-40-people", Scene::named("office", {.people = 40}));
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
