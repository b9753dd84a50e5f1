// SPDX-License-Identifier: Apache-2.0
#include "replay/evaluation/patch_metrics.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

namespace convexcut::evaluation {
namespace {

using simulation::SurfaceLabel;

// Of one patch.
struct Tally {
  std::uint64_t points = 0;
  std::uint64_t covered = 0;  // of the input's: in the output; of the output's: in kept ones
  std::uint64_t judged = 0;
  std::uint64_t structure = 0;

  void add(SurfaceLabel truth, bool is_covered) noexcept {
    ++points;
    covered += is_covered ? 1U : 0U;
    judged += truth != SurfaceLabel::none ? 1U : 0U;
    structure += truth == SurfaceLabel::structure ? 1U : 0U;
  }
  [[nodiscard]] bool is_structure() const noexcept { return 2 * structure > judged; }
  [[nodiscard]] bool half_covered() const noexcept { return 2 * covered >= points; }
};

template <class IsCovered>
[[nodiscard]] std::vector<Tally> tally(std::span<const std::uint32_t> patch,
                                       std::span<const SurfaceLabel> truth,
                                       IsCovered&& is_covered) {
  std::vector<Tally> tallies;
  for (std::size_t i = 0; i < patch.size(); ++i) {
    if (patch[i] == kNoPatch) continue;
    if (patch[i] >= tallies.size()) tallies.resize(std::size_t{patch[i]} + 1);
    tallies[patch[i]].add(truth[i], is_covered(i));
  }
  return tallies;
}

}  // namespace

PatchCounts& PatchCounts::operator+=(const PatchCounts& other) noexcept {
  objects_removed += other.objects_removed;
  objects_kept += other.objects_kept;
  structure_kept += other.structure_kept;
  structure_lost += other.structure_lost;
  object_fragments += other.object_fragments;
  return *this;
}

PatchCounts count_patches(std::span<const std::uint32_t> input_patch, std::span<const Label> result,
                          std::span<const std::uint32_t> output_patch,
                          std::span<const SurfaceLabel> truth) {
  if (input_patch.size() != truth.size() || result.size() != truth.size() ||
      output_patch.size() != truth.size()) {
    throw std::invalid_argument("patches, labels and truth of a scan differ in number");
  }
  const std::vector<Tally> inputs =
      tally(input_patch, truth, [&](std::size_t i) { return result[i] == Label::structure; });
  const std::vector<Tally> outputs = tally(output_patch, truth, [&](std::size_t i) {
    return input_patch[i] != kNoPatch && inputs[input_patch[i]].half_covered();
  });
  PatchCounts counts;
  for (const Tally& patch : inputs) {
    if (patch.judged == 0) continue;
    if (patch.is_structure()) {
      ++(patch.half_covered() ? counts.structure_kept : counts.structure_lost);
    } else {
      ++(patch.half_covered() ? counts.objects_kept : counts.objects_removed);
    }
  }
  for (const Tally& patch : outputs) {
    if (patch.judged == 0 || patch.half_covered() || patch.is_structure()) continue;
    ++counts.objects_kept;
    ++counts.object_fragments;
  }
  return counts;
}

PatchJudge::PatchJudge(const PlaneOptions& options) : extractor_(options) {}

void PatchJudge::set_input(const CloudView& cloud, std::span<const SurfaceLabel> truth) {
  if (cloud.size() != truth.size()) {
    throw std::invalid_argument("cloud and truth of a scan differ in number");
  }
  const PlanePatches patches = extractor_.extract(cloud);
  input_.assign(patches.patch_of_point.begin(), patches.patch_of_point.end());
  x_.assign(cloud.x.begin(), cloud.x.end());
  y_.assign(cloud.y.begin(), cloud.y.end());
  z_.assign(cloud.z.begin(), cloud.z.end());
  truth_.assign(truth.begin(), truth.end());
}

PatchCounts PatchJudge::judge(std::span<const Label> result) {
  if (result.size() != truth_.size()) {
    throw std::invalid_argument("labels and truth of a scan differ in number");
  }
  for (auto* column : {&kept_x_, &kept_y_, &kept_z_}) column->clear();
  kept_.clear();
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (result[i] != Label::structure) continue;
    kept_x_.push_back(x_[i]);
    kept_y_.push_back(y_[i]);
    kept_z_.push_back(z_[i]);
    kept_.push_back(static_cast<std::uint32_t>(i));
  }
  const PlanePatches patches = extractor_.extract({kept_x_, kept_y_, kept_z_});
  output_.assign(result.size(), kNoPatch);
  for (std::size_t k = 0; k < kept_.size(); ++k) output_[kept_[k]] = patches.patch_of_point[k];
  return count_patches(input_, result, output_, truth_);
}

}  // namespace convexcut::evaluation
