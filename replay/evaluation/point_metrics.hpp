// SPDX-License-Identifier: Apache-2.0
//
// How well labels separate structure from the rest, point by point. Arrays in, numbers out: scans
// in memory and scans in files are measured alike. Pure; throws std::invalid_argument when spans
// that belong to one cloud differ in length.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/cloud.hpp"
#include "replay/simulation/scene/surface_label.hpp"

namespace convexcut::evaluation {

// Structure is what is looked for. Points whose true label is `none` are in no count but theirs.
struct PointCounts {
  std::uint64_t true_positive = 0;   // structure, kept
  std::uint64_t false_positive = 0;  // object or dynamic, kept
  std::uint64_t false_negative = 0;  // structure, removed
  std::uint64_t true_negative = 0;   // object or dynamic, removed
  std::uint64_t dynamic = 0;         // of these, truly dynamic
  std::uint64_t unjudged = 0;        // true label none
  std::uint64_t unjudged_kept = 0;   // of those, labelled structure

  [[nodiscard]] std::uint64_t judged() const noexcept {
    return true_positive + false_positive + false_negative + true_negative;
  }
  PointCounts& operator+=(const PointCounts& other) noexcept;
};

// All 0 … 1. With TP, FP, FN as above:
//   precision = TP / (TP + FP); when nothing was kept: 1 if there is no structure, else 0
//   recall = TP / (TP + FN); 1 when there is no structure
//   f = 2 · TP / (2 · TP + FP + FN), the harmonic mean of both; 1 when that is 0 / 0
struct Score {
  double precision = 1.0;
  double recall = 1.0;
  double f = 1.0;
};
[[nodiscard]] Score score_of(std::uint64_t true_positive, std::uint64_t false_positive,
                             std::uint64_t false_negative) noexcept;

// Shares of the judged points; 0 when there are none.
[[nodiscard]] double dynamic_ratio(const PointCounts& counts) noexcept;

[[nodiscard]] PointCounts count_points(std::span<const Label> result,
                                       std::span<const simulation::SurfaceLabel> truth);
[[nodiscard]] inline Score score_of(const PointCounts& counts) noexcept {
  return score_of(counts.true_positive, counts.false_positive, counts.false_negative);
}

// Of one surface of the scene.
struct SurfaceCounts {
  std::uint64_t points = 0;
  std::uint64_t kept = 0;   // labelled structure
  std::uint64_t wrong = 0;  // kept although object or dynamic, or removed although structure
};

// Adds a scan to the counts by surface; points of true label `none` are left out. `by_surface`
// grows to the largest surface that occurs.
void add_surfaces(std::span<const Label> result, std::span<const simulation::SurfaceLabel> truth,
                  std::span<const std::uint16_t> surface, std::vector<SurfaceCounts>& by_surface);

}  // namespace convexcut::evaluation
