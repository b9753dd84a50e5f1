// SPDX-License-Identifier: Apache-2.0
//
// How well labels separate structure from the rest, plane patch by plane patch, as in the paper
// (Jun, Youn, Choi, Medioni, Doh: "Convex Cut", the section on evaluation): patches are extracted
// from the input cloud and from the output cloud (the points labelled structure), and every patch
// falls into one of four classes:
//   A  patch of an object that was removed      B  patch of an object that was kept
//   C  patch of structure that was kept         D  patch of structure that was lost
//   precision = N_C / (N_B + N_C), recall = N_C / (N_C + N_D)
//
// What the paper leaves open is set here:
// * A patch is real structure when more than half of its judged points (true label not `none`) are,
//   otherwise it is an object's; people are objects. A patch without judged points is in no class.
// * A patch of the input is kept when at least half of its points are in the output, whatever
//   patches of the output they are in: a smaller cloud has others, also where nothing is missing.
//   So labels that are the truth have precision and recall 1.
// * A patch of the output is a *fragment* when more than half of its points are in no kept patch of
//   the input: the output shows something that the classes above have counted as removed or lost,
//   or never saw. An object's fragment counts as B; a fragment of structure counts as nothing.
// So every patch that the output shows falsely costs precision, and nothing is counted as
// structure that was found twice.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/cloud.hpp"
#include "core/planes/plane_extractor.hpp"
#include "replay/evaluation/point_metrics.hpp"
#include "replay/simulation/scene/surface_label.hpp"

namespace convexcut::evaluation {

struct PatchCounts {
  std::uint64_t objects_removed = 0;   // A
  std::uint64_t objects_kept = 0;      // B, with fragments
  std::uint64_t structure_kept = 0;    // C
  std::uint64_t structure_lost = 0;    // D
  std::uint64_t object_fragments = 0;  // of B

  PatchCounts& operator+=(const PatchCounts& other) noexcept;
};

// Precision, recall and F of the patches, with the conventions of points (point_metrics.hpp).
[[nodiscard]] inline Score score_of(const PatchCounts& counts) noexcept {
  return score_of(counts.structure_kept, counts.objects_kept, counts.structure_lost);
}

// For each point of the input: the number of its patch of the input cloud (or kNoPatch), its label,
// and the number of its patch of the output cloud (kNoPatch also for a point that was removed).
// Throws std::invalid_argument when the spans differ in length.
[[nodiscard]] PatchCounts count_patches(std::span<const std::uint32_t> input_patch,
                                        std::span<const Label> result,
                                        std::span<const std::uint32_t> output_patch,
                                        std::span<const simulation::SurfaceLabel> truth);

// What counts as a patch: smaller ones say more about the extractor than about the cloud.
inline constexpr PlaneOptions kJudgedPatches{.least_patch_points = 100, .least_patch_width_m = 0.2};

// Extracts the patches of both clouds. The workspace is kept from scan to scan.
class PatchJudge {
 public:
  explicit PatchJudge(const PlaneOptions& options = kJudgedPatches);

  // Takes the patches of an input cloud; then any number of results can be judged by it. The truth
  // is copied. Throws std::invalid_argument when the spans differ in length.
  void set_input(const CloudView& cloud, std::span<const simulation::SurfaceLabel> truth);

  // One label for each point of the input.
  [[nodiscard]] PatchCounts judge(std::span<const Label> result);

  // Of the newest judge(): for each point of the input its patch, or kNoPatch.
  [[nodiscard]] std::span<const std::uint32_t> input_patches() const noexcept { return input_; }
  [[nodiscard]] std::span<const std::uint32_t> output_patches() const noexcept { return output_; }

 private:
  PlaneExtractor extractor_;
  std::vector<float> x_, y_, z_;  // the input
  std::vector<simulation::SurfaceLabel> truth_;
  std::vector<std::uint32_t> input_, output_;
  std::vector<float> kept_x_, kept_y_, kept_z_;
  std::vector<std::uint32_t> kept_;  // indices into the input
};

}  // namespace convexcut::evaluation
