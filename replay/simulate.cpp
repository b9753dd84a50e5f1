// SPDX-License-Identifier: Apache-2.0
#include "replay/simulate.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/loader.hpp"
#include "replay/picture.hpp"
#include "replay/progress_bar.hpp"
#include "replay/simulation/labelled_scans.hpp"
#include "replay/simulation/recording.hpp"
#include "replay/staged_folder.hpp"
#include "replay/stop_signal.hpp"
#include "replay/text.hpp"

namespace convexcut::replay {
namespace {

using simulation::Scene;
using simulation::SimulationOptions;

Scene open_scene(const SimulateOptions& options) {
  try {
    return Scene::open(options.scene, options.scene_options);
  } catch (const simulation::SceneError& error) {
    throw config::ConfigError(error.what());
  }
}

// One revolution as it was simulated, levelled by the truth; what is structure in truth is drawn as
// structure.
void draw(const Scene& scene, const SimulationOptions& simulated, const std::string& title,
          const std::filesystem::path& png) {
  simulation::LabelledScanOptions options;
  options.simulation = simulated;
  options.simulation.length = std::chrono::milliseconds{450};  // 5 Hz: a whole revolution within
  options.levelling = simulation::Levelling::truth;
  simulation::LabelledScans scans(scene, options);
  simulation::LabelledScan scan;
  if (!scans.next(scan)) throw std::runtime_error("no whole revolution to draw");
  std::vector<Label> label(scan.label.size());
  std::ranges::transform(scan.label, label.begin(), [](simulation::SurfaceLabel truth) {
    return truth == simulation::SurfaceLabel::structure ? Label::structure : Label::other;
  });
  render_picture({.cloud = scan.scan.cloud(), .label = label, .title = title}, png);
}

void report(const SimulateOptions& options, const std::string& scene,
            const simulation::RecordingSummary& summary, std::chrono::duration<double> elapsed) {
  const double length = seconds(options.simulation.length);
  const double rate = elapsed.count() > 0 ? length / elapsed.count() : 0.0;
  if (options.json) {
    JsonObject json;
    json.add("scene", scene)
        .add("seed", options.simulation.seed)
        .add("seconds", length, 3)
        .add("packets", summary.packets)
        .add("firings", summary.firings)
        .add("returns", summary.returns)
        .add("ghosts", summary.ghosts)
        .add("mixed", summary.mixed)
        .add("elapsed_s", elapsed.count(), 3)
        .add("times_real_time", rate, 2)
        .add("out", options.out.string());
    std::puts(json.text().c_str());
    return;
  }
  std::printf("scene        %s, seed %s\n", scene.c_str(),
              std::to_string(options.simulation.seed).c_str());
  std::printf("simulated    %.3f s, %s packets, %s returns (%s ghosts, %s mixed)\n", length,
              grouped(summary.packets).c_str(), grouped(summary.returns).c_str(),
              grouped(summary.ghosts).c_str(), grouped(summary.mixed).c_str());
  std::printf("written      %s\n", options.out.c_str());
  std::printf("time         %.3f s = %.1f x real time\n", elapsed.count(), rate);
}

}  // namespace

void simulate(const SimulateOptions& options) {
  const auto started = std::chrono::steady_clock::now();
  const Scene scene = open_scene(options);
  SimulationOptions simulation = options.simulation;
  options.place_rig(scene, simulation.rig);
  const StopSignal stop;
  StagedFolder folder(options.out);
  ProgressBar bar("simulate");
  const simulation::RecordingSummary summary = simulation::write_recording(
      scene, simulation, folder.path(), [&](std::uint64_t done, std::uint64_t total) {
        if (stop.came()) throw std::runtime_error("stopped by a signal: nothing is written");
        bar.update(done, total);
      });
  const std::string title =
      scene.name() + ", seed " + std::to_string(simulation.seed) + ": what is structure";
  if (!options.picture.empty()) draw(scene, simulation, title, options.picture);
  folder.commit();
  report(options, scene.name(), summary, std::chrono::steady_clock::now() - started);
}

}  // namespace convexcut::replay
