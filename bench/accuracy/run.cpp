// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/run.hpp"

#include <algorithm>
#include <ctime>
#include <memory>
#include <optional>
#include <utility>

#include "replay/evaluation/patch_metrics.hpp"

namespace convexcut::bench {
namespace {

using evaluation::PatchJudge;
using simulation::LabelledScan;
using simulation::SurfaceLabel;

constexpr std::size_t kSettled = 10;  // scans

// CPU time of this thread: others may share the processor.
[[nodiscard]] double milliseconds_used() {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) * 1e3 + static_cast<double>(used.tv_nsec) * 1e-6;
}

// Clouds in the frame of the world, to be judged as one.
class MergedCloud {
 public:
  void add(const LabelledScan& scan, const Vec3& position) {
    for (std::size_t i = 0; i < scan.scan.size(); ++i) {
      x_.push_back(scan.scan.x[i] + static_cast<float>(position.x()));
      y_.push_back(scan.scan.y[i] + static_cast<float>(position.y()));
      z_.push_back(scan.scan.z[i] + static_cast<float>(position.z()));
    }
    truth_.insert(truth_.end(), scan.label.begin(), scan.label.end());
    surface_.insert(surface_.end(), scan.surface.begin(), scan.surface.end());
  }
  void clear() {
    for (std::vector<float>* column : {&x_, &y_, &z_}) column->clear();
    truth_.clear();
    surface_.clear();
  }
  [[nodiscard]] CloudView view() const { return {x_, y_, z_}; }
  [[nodiscard]] const std::vector<SurfaceLabel>& truth() const { return truth_; }
  [[nodiscard]] const std::vector<std::uint16_t>& surface() const { return surface_; }

 private:
  std::vector<float> x_, y_, z_;
  std::vector<SurfaceLabel> truth_;
  std::vector<std::uint16_t> surface_;
};

struct Contestant {
  std::unique_ptr<Method> method;
  std::vector<Label> labels;
  std::vector<Label> merged;  // of the merged cloud
  std::vector<evaluation::SurfaceCounts> by_surface;
  Outcome outcome;

  void label(const LabelledScan& scan, const Vec3& position) {
    labels.assign(scan.scan.size(), Label::other);
    const double begin = milliseconds_used();
    method->label(scan.scan.cloud(), position, labels);
    outcome.milliseconds += milliseconds_used() - begin;
    ++outcome.scans;
    merged.insert(merged.end(), labels.begin(), labels.end());
  }

  void judge(const MergedCloud& cloud, bool settled) {
    const std::vector<SurfaceLabel>& truth = cloud.truth();
    evaluation::add_surfaces(merged, truth, cloud.surface(), by_surface);
    const evaluation::PointCounts counts = evaluation::count_points(merged, truth);
    outcome.points.add(score_of(counts));
    if (settled) outcome.settled.add(score_of(counts));
    outcome.pooled += counts;
    outcome.dynamic_ratio.add(evaluation::dynamic_ratio(counts));
  }

  void take_errors(const simulation::Scene& scene) {
    constexpr std::size_t kMost = 12;
    for (std::size_t i = 0; i < by_surface.size(); ++i) {
      if (by_surface[i].wrong > 0) {
        outcome.errors.push_back({scene.surfaces()[i].name, by_surface[i]});
      }
    }
    std::stable_sort(outcome.errors.begin(), outcome.errors.end(),
                     [](const SurfaceErrors& a, const SurfaceErrors& b) {
                       return a.counts.wrong > b.counts.wrong;
                     });
    outcome.errors.resize(std::min(outcome.errors.size(), kMost));
  }

  void judge_patches(PatchJudge& judge) {
    const evaluation::PatchCounts counts = judge.judge(merged);
    outcome.patches.add(score_of(counts));
    outcome.pooled_patches += counts;
  }
};

// What an IMU makes of a building that is askew to its axes.
void turn(LevelledScan& scan, const Quaternion& q) {
  const Eigen::Matrix3f r = q.toRotationMatrix().cast<float>();
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Vec3f p = r * Vec3f(scan.x[i], scan.y[i], scan.z[i]);
    scan.x[i] = p.x();
    scan.y[i] = p.y();
  }
}

}  // namespace

std::vector<Outcome> outcomes_of(const Run& run, const std::vector<NamedMethod>& methods) {
  simulation::SceneOptions scene_options;
  if (run.people >= 0) scene_options.people = run.people;
  const simulation::Scene scene = simulation::Scene::open(run.scene, scene_options);
  simulation::LabelledScans scans(scene, run.options);
  std::vector<Contestant> contestants;
  for (const NamedMethod& method : methods) {
    Contestant contestant;
    contestant.method = method.make();
    contestant.outcome.method = method.name;
    contestants.push_back(std::move(contestant));
  }
  const Quaternion q_heading = to_quaternion({{0.0}, {0.0}, run.heading});
  PatchJudge patch_judge;
  MergedCloud cloud;
  LabelledScan scan;
  std::size_t clouds = 0;
  for (std::size_t index = 0; index < run.most_scans && scans.next(scan); ++index) {
    const Vec3 position = scans.pose_at(scan.scan.stamp).position_world;
    cloud.add(scan, position);  // what is judged is as the building is
    turn(scan.scan, q_heading);
    for (Contestant& c : contestants) c.label(scan, q_heading * position);
    if ((index + 1) % run.merge != 0) continue;
    const bool patches = run.judge_patches_every > 0 && clouds % run.judge_patches_every == 0;
    if (clouds % run.judge_every == 0) {
      for (Contestant& c : contestants) c.judge(cloud, index >= kSettled);
    }
    if (patches) {
      patch_judge.set_input(cloud.view(), cloud.truth());
      for (Contestant& c : contestants) c.judge_patches(patch_judge);
    }
    ++clouds;
    cloud.clear();
    for (Contestant& c : contestants) c.merged.clear();
  }
  std::vector<Outcome> outcomes;
  for (Contestant& c : contestants) {
    c.take_errors(scene);
    outcomes.push_back(std::move(c.outcome));
  }
  return outcomes;
}

}  // namespace convexcut::bench
