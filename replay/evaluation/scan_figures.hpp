// SPDX-License-Identifier: Apache-2.0
//
// The figures of one scan, and of many.
#pragma once

#include "replay/evaluation/patch_metrics.hpp"
#include "replay/evaluation/point_metrics.hpp"
#include "replay/evaluation/summary.hpp"

namespace convexcut::evaluation {

struct ScanFigures {
  PointCounts points;
  PatchCounts patches;

  [[nodiscard]] Score point_score() const noexcept { return score_of(points); }
  [[nodiscard]] Score patch_score() const noexcept { return score_of(patches); }
};

// Mean ± standard deviation and the worst scan, of each score.
struct ScoreSummary {
  Summary precision, recall, f;

  void add(const Score& score) noexcept {
    precision.add(score.precision);
    recall.add(score.recall);
    f.add(score.f);
  }
};

class Totals {
 public:
  void add(const ScanFigures& scan) noexcept {
    points_.add(scan.point_score());
    patches_.add(scan.patch_score());
    dynamic_ratio_.add(dynamic_ratio(scan.points));
    sum_.points += scan.points;
    sum_.patches += scan.patches;
  }

  // Every scan counts alike, as in the paper.
  [[nodiscard]] const ScoreSummary& points() const noexcept { return points_; }
  [[nodiscard]] const ScoreSummary& patches() const noexcept { return patches_; }
  [[nodiscard]] const Summary& dynamic_ratios() const noexcept { return dynamic_ratio_; }
  // Every point, and every patch, counts alike.
  [[nodiscard]] const ScanFigures& pooled() const noexcept { return sum_; }

 private:
  ScoreSummary points_, patches_;
  Summary dynamic_ratio_;
  ScanFigures sum_;
};

}  // namespace convexcut::evaluation
