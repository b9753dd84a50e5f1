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

// Labels one revolution after the other, again from the first after the last.
class Player {
 public:
  Player(const std::vector<simulation::LabelledScan>& revolutions, std::size_t most_points)
      : revolutions_(revolutions), robust_({}, most_points), labels_(most_points) {
    while (next_ < kRevolutions) label();
  }

  void label() {
    const CloudView cloud = next();
    require_ok(robust_.label(cloud, std::span(labels_).first(cloud.size())));
  }
  void label_at_once() {
    const CloudView cloud = next();
    require_ok(robust_.label_at_once(cloud, std::span(labels_).first(cloud.size())));
  }
  void learn(RobustCut::Learning learning) { robust_.learn(learning); }
  [[nodiscard]] std::size_t voxels() const { return robust_.model().surfels.size(); }

 private:
  [[nodiscard]] CloudView next() { return revolutions_[next_++ % kRevolutions].scan.cloud(); }
  static void require_ok(CutStatus status) {
    if (status != CutStatus::ok) throw std::runtime_error("a simulated revolution was refused");
  }

  const std::vector<simulation::LabelledScan>& revolutions_;
  RobustCut robust_;
  std::vector<Label> labels_;
  std::size_t next_ = 0;
};

[[nodiscard]] Timing half_of(const Timing& t) {
  return {t.name, t.median_ms / 2, t.p99_ms / 2, t.max_ms / 2};
}

}  // namespace

RobustResult compare_robust(const std::string& scene, unsigned rounds) {
  const std::vector<simulation::LabelledScan> revolutions = revolutions_in(scene);
  std::size_t most_points = 0;
  for (const auto& r : revolutions) most_points = std::max(most_points, r.scan.size());
  using Learning = RobustCut::Learning;
  Player usual(revolutions, most_points);
  Player at_once(revolutions, most_points);
  Player thrifty(revolutions, most_points);
  const CloudView last = revolutions.back().scan.cloud();
  std::vector<Label> literal(last.size());
  const std::vector<Contender> contenders{
      {"qhull", [&] { label_literally({}, last, hull_by_qhull, literal); }},
      {"robust", [&] { usual.label(); }, kRunsARound},
      {"robust_at_once", [&] { at_once.label_at_once(); }, kRunsARound,
       [&] { at_once.learn(Learning::now); }},
      {"robust_thrifty",
       [&] {
         for (const Learning learning : {Learning::later, Learning::now}) {
           thrifty.label_at_once();
           thrifty.learn(learning);
         }
       },
       kRunsARound}};
  RobustResult result{scene, last.size(), measure(contenders, rounds), usual.voxels()};
  result.timings.back() = half_of(result.timings.back());
  return result;
}

}  // namespace convexcut::bench
