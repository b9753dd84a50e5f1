// SPDX-License-Identifier: Apache-2.0
//
// Both methods on simulated scenes: the paper's figure 3, and floors below which F must not fall.
// The floors leave room for other compilers; how good the methods are is docs/accuracy.md's matter.
#include <chrono>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/robust_cut.hpp"
#include "replay/evaluation/point_metrics.hpp"
#include "replay/simulation/labelled_scans.hpp"

namespace convexcut {
namespace {

using simulation::LabelledScan;
using simulation::LabelledScans;
using simulation::Scene;

struct Result {
  LabelledScan scan;
  std::vector<Label> labels;
  std::map<std::string, double> kept;  // share of its points, by surface
};

// Of the last revolution of a lidar that is tilted and turns by 9° a revolution.
[[nodiscard]] Result robust_in(const std::string& name, int revolutions) {
  const Scene scene = Scene::named(name);
  simulation::LabelledScanOptions options;
  options.simulation.seed = 11;
  options.simulation.length = std::chrono::milliseconds{100 * revolutions + 150};
  options.simulation.rig = simulation::planned_rig(scene, false);
  options.simulation.rig.tilt = Degrees{30.0};
  options.simulation.rig.rotation_per_second = Degrees{90.0};
  LabelledScans scans(scene, options);
  RobustCut robust({}, 100'000);
  Result result;
  for (int i = 0; i < revolutions && scans.next(result.scan); ++i) {
    result.labels.assign(result.scan.scan.size(), Label::other);
    EXPECT_EQ(robust.label(result.scan.scan.cloud(), result.labels), CutStatus::ok);
  }
  std::vector<evaluation::SurfaceCounts> counts;
  evaluation::add_surfaces(result.labels, result.scan.label, result.scan.surface, counts);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i].points < 50) continue;
    result.kept[scene.surfaces()[i].name] =
        static_cast<double>(counts[i].kept) / static_cast<double>(counts[i].points);
  }
  return result;
}

[[nodiscard]] double f_of(const Result& result) {
  return evaluation::score_of(evaluation::count_points(result.labels, result.scan.label)).f;
}

TEST(RobustScenes, HouseIsThePapersFigure3) {
  const Result house = robust_in("house", 18);
  for (const std::string name : {"C1", "F1", "F2", "P1", "P2"}) {
    ASSERT_TRUE(house.kept.contains(name)) << name;
    EXPECT_GT(house.kept.at(name), 0.6) << name;
  }
  if (house.kept.contains("C2")) {
    EXPECT_GT(house.kept.at("C2"), 0.6);
  }
  for (const std::string name : {"E", "D"}) {
    ASSERT_TRUE(house.kept.contains(name)) << name;
    EXPECT_LT(house.kept.at(name), 0.15) << name;
  }
  EXPECT_GT(f_of(house), 0.97);
}

TEST(RobustScenes, OfficeAndLShape) {
  EXPECT_GT(f_of(robust_in("office", 12)), 0.93);
  EXPECT_GT(f_of(robust_in("l-shape", 12)), 0.96);
}

}  // namespace
}  // namespace convexcut
