// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/experiments.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "replay/simulation/scene/scene.hpp"
#include "replay/simulation/simulation.hpp"

namespace convexcut::bench {
namespace {

using simulation::Scene;

constexpr std::array<double, 3> kTiltsDeg{0.0, 30.0, 60.0};
constexpr Degrees kStage{60.0};  // the stage turns that far in a second
constexpr int kSeeds = 3;
constexpr std::array<std::string_view, 3> kFewScenes{"office", "l-shape", "corridor"};

// Between 0 and 1, evenly: the fractional part of multiples of an irrational number.
[[nodiscard]] double evenly(std::uint64_t seed, double irrational) {
  const double multiple = static_cast<double>(seed) * irrational;
  return multiple - std::floor(multiple);
}

// A building's walls are neither along an IMU's axes nor at round distances from a rig, as a
// scene's would be, and what divides space into cells may not live on that: both by the seed.
void place_by_seed(Run& run, bool travels) {
  constexpr double kQuarterTurnDeg = 90.0;
  constexpr double kOffsetM = 0.2;
  const std::uint64_t seed = run.options.simulation.seed;
  run.heading = Degrees{kQuarterTurnDeg * evenly(seed, 0.6180339887)};
  const Vec3 offset_m{kOffsetM * (evenly(seed, 0.7548776662) - 0.5),
                      kOffsetM * (evenly(seed, 0.5698402910) - 0.5), 0.0};
  run.options.simulation.rig = simulation::planned_rig(Scene::open(run.scene), travels, offset_m);
}

[[nodiscard]] Run make_run(std::string experiment, std::string_view scene, double tilt_deg,
                           std::uint64_t seed, double seconds, bool travels = false) {
  Run run;
  run.experiment = std::move(experiment);
  run.scene = scene;
  run.tilt_deg = tilt_deg;
  simulation::SimulationOptions& options = run.options.simulation;
  options.seed = seed;
  options.length = std::chrono::milliseconds{static_cast<std::int64_t>(seconds * 1e3)};
  place_by_seed(run, travels);
  options.rig.tilt = Degrees{tilt_deg};
  options.rig.rotation_per_second = kStage;
  return run;
}

// A room with a mirror in a wall, beside what any room has.
constexpr std::string_view kMirrorScene = "bench/accuracy/mirror.toml";

[[nodiscard]] Experiment scenes(const ExperimentOptions& o) {
  Experiment experiment{{}, compared_methods()};
  for (const std::string_view scene : Scene::names()) {
    for (const double tilt : kTiltsDeg) {
      for (int i = 0; i < (o.quick ? 1 : kSeeds); ++i) {
        Run run = make_run("scenes", scene, tilt, o.first_seed + static_cast<std::uint64_t>(i),
                           o.quick ? 1.6 : 3.2);
        run.judge_every = 3;
        run.judge_patches_every = o.quick ? 6 : 9;
        experiment.runs.push_back(std::move(run));
      }
    }
  }
  return experiment;
}

[[nodiscard]] Experiment disturbed(const ExperimentOptions& o, const std::string& name,
                                   const std::vector<std::pair<std::string, double>>& variants,
                                   void (*disturb)(Run&, double)) {
  Experiment experiment{{}, compared_methods()};
  for (const std::string_view scene : kFewScenes) {
    for (const double tilt : kTiltsDeg) {
      for (const auto& [variant, value] : variants) {
        Run run = make_run(name, scene, tilt, o.first_seed, o.quick ? 1.4 : 2.5);
        run.variant = variant;
        run.judge_every = 3;
        disturb(run, value);
        experiment.runs.push_back(std::move(run));
      }
    }
  }
  return experiment;
}

[[nodiscard]] Experiment mirror(const ExperimentOptions& o) {
  Experiment experiment{{}, compared_methods()};
  for (const double tilt : kTiltsDeg) {
    Run run = make_run("mirror", kMirrorScene, tilt, o.first_seed, o.quick ? 1.4 : 2.5);
    run.judge_every = 3;
    experiment.runs.push_back(std::move(run));
  }
  return experiment;
}

[[nodiscard]] Experiment ablation(const ExperimentOptions& o) {
  Experiment experiment{{}, ablations()};
  for (const std::string_view scene : Scene::names()) {
    for (const double tilt : kTiltsDeg) {
      Run run = make_run("ablation", scene, tilt, o.first_seed, o.quick ? 1.2 : 2.0);
      run.judge_every = 4;
      experiment.runs.push_back(std::move(run));
    }
  }
  return experiment;
}

// The paper's stationary experiments: a tilted lidar that turns, as many scans as the paper has.
[[nodiscard]] Experiment stationary(const ExperimentOptions& o, const std::string& scene,
                                    std::size_t scans) {
  const std::size_t count = o.quick ? 30 : scans;
  Run run = make_run(scene, scene, 30.0, o.first_seed, 0.1 * static_cast<double>(count) + 0.5);
  run.most_scans = count;
  run.judge_patches_every = 4;
  return {{std::move(run)}, compared_methods()};
}

// And the moving one: data sets of 100 scans, each judged as one cloud.
[[nodiscard]] Experiment moving(const ExperimentOptions& o) {
  constexpr std::size_t kMerged = 100;
  constexpr int kDataSets = 14;
  Experiment experiment{{}, compared_methods()};
  experiment.methods.push_back(robust_with_positions());
  for (int i = 0; i < (o.quick ? 1 : kDataSets); ++i) {
    Run run = make_run("moving", "glass-offices", 30.0,
                       o.first_seed + static_cast<std::uint64_t>(i), o.quick ? 2.5 : 10.5, true);
    run.options.simulation.rig.yaw = Degrees{25.0 * i};
    run.merge = o.quick ? 20 : kMerged;
    run.most_scans = run.merge;
    run.judge_patches_every = 1;
    experiment.runs.push_back(std::move(run));
  }
  return experiment;
}

[[nodiscard]] bool is_asked_for(const ExperimentOptions& o, const Run& run) {
  return (o.only.empty() || run.experiment == o.only) &&
         (o.scene.empty() || run.scene == o.scene) &&
         (o.tilt_deg < 0.0 || run.tilt_deg == o.tilt_deg);
}

}  // namespace

std::vector<Experiment> experiments(const ExperimentOptions& o) {
  std::vector<Experiment> all{
      scenes(o),
      disturbed(o, "ghosts", {{"none", 0.0}, {"1 %", 0.01}},
                [](Run& run, double share) { run.options.simulation.lidar.ghosts = share; }),
      disturbed(o, "gravity", {{"right", 0.0}, {"2°", 2.0}, {"5°", 5.0}},
                [](Run& run, double degrees) {
                  run.options.simulation.imu_errors.gravity = Degrees{degrees};
                }),
      disturbed(o, "dynamic",
                {{"0", 0}, {"10", 10}, {"20", 20}, {"40", 40}, {"60", 60}, {"80", 80}},
                [](Run& run, double people) { run.people = static_cast<int>(people); }),
      mirror(o),
      ablation(o),
      stationary(o, "office", 760),
      stationary(o, "cafe", 356),
      moving(o)};
  for (Experiment& experiment : all) {
    std::erase_if(experiment.runs, [&](const Run& run) { return !is_asked_for(o, run); });
    std::erase_if(experiment.methods, [&](const NamedMethod& method) {
      return !o.method.empty() && method.name != o.method;
    });
  }
  return all;
}

}  // namespace convexcut::bench
