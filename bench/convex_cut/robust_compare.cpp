// SPDX-License-Identifier: Apache-2.0
#include "bench/convex_cut/robust_compare.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <stdexcept>

#include "bench/convex_cut/literal.hpp"
#include "core/convex_cut/robust/robust_cut.hpp"
#include "replay/simulation/labelled_scans.hpp"

namespace convexcut::bench {
namespace {

constexpr std::uint64_t kSeed = 7;
constexpr std::size_t kRevolutions = 40;  // more than the window holds
constexpr unsigned kRunsARound = 4;

[[nodiscard]] std::vector<simulation::LabelledScan> revolutions_in(const std::string& name) {
  const simulation::Scene scene = simulation::Scene::named(name);
  simulation::LabelledScanOptions options;
  options.simulation.seed = kSeed;
  options.simulation.length = std::chrono::milliseconds{100 * (kRevolutions + 2)};
  options.simulation.rig = simulation::planned_rig(scene, false);
  options.simulation.rig.tilt = Degrees{30.0};
  options.simulation.rig.rotation_per_second = Degrees{60.0};
  simulation::LabelledScans scans(scene, options);
  std::vector<simulation::LabelledScan> all(kRevolutions);
  for (simulation::LabelledScan& scan : all) {
    if (!scans.next(scan)) throw std::runtime_error("the simulator ended early");
  }
  return all;
}

}  // namespace

RobustResult compare_robust(const std::string& scene, unsigned rounds) {
  const std::vector<simulation::LabelledScan> revolutions = revolutions_in(scene);
  std::size_t most_points = 0;
  for (const auto& r : revolutions) most_points = std::max(most_points, r.scan.size());
  RobustCut robust({}, most_points);
  std::vector<Label> labels(most_points);
  std::size_t next = 0;
  const auto label = [&] {
    const CloudView cloud = revolutions[next++ % kRevolutions].scan.cloud();
    if (robust.label(cloud, std::span(labels).first(cloud.size())) != CutStatus::ok) {
      throw std::runtime_error("a simulated revolution was refused");
    }
  };
  while (next < kRevolutions) label();
  const CloudView last = revolutions.back().scan.cloud();
  std::vector<Label> literal(last.size());
  const std::vector<Contender> contenders{
      {"qhull", [&] { label_literally({}, last, hull_by_qhull, literal); }},
      {"robust", label, kRunsARound}};
  RobustResult result{scene, last.size(), measure(contenders, rounds), 0};
  result.voxels = robust.model().surfels.size();
  return result;
}

}  // namespace convexcut::bench
