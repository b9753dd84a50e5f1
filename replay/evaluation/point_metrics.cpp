// SPDX-License-Identifier: Apache-2.0
#include "replay/evaluation/point_metrics.hpp"

#include <cstddef>
#include <stdexcept>

namespace convexcut::evaluation {
namespace {

using simulation::SurfaceLabel;

[[nodiscard]] double ratio(std::uint64_t part, std::uint64_t whole, double of_nothing) noexcept {
  return whole == 0 ? of_nothing : static_cast<double>(part) / static_cast<double>(whole);
}

[[nodiscard]] bool is_wrong(Label result, SurfaceLabel truth) noexcept {
  return (result == Label::structure) != (truth == SurfaceLabel::structure);
}

}  // namespace

PointCounts& PointCounts::operator+=(const PointCounts& other) noexcept {
  true_positive += other.true_positive;
  false_positive += other.false_positive;
  false_negative += other.false_negative;
  true_negative += other.true_negative;
  dynamic += other.dynamic;
  unjudged += other.unjudged;
  unjudged_kept += other.unjudged_kept;
  return *this;
}

Score score_of(std::uint64_t true_positive, std::uint64_t false_positive,
               std::uint64_t false_negative) noexcept {
  const std::uint64_t kept = true_positive + false_positive;
  const std::uint64_t structure = true_positive + false_negative;
  return {.precision = ratio(true_positive, kept, structure == 0 ? 1.0 : 0.0),
          .recall = ratio(true_positive, structure, 1.0),
          .f = ratio(2 * true_positive, kept + structure, 1.0)};
}

double dynamic_ratio(const PointCounts& counts) noexcept {
  return ratio(counts.dynamic, counts.judged(), 0.0);
}

PointCounts count_points(std::span<const Label> result, std::span<const SurfaceLabel> truth) {
  if (result.size() != truth.size()) {
    throw std::invalid_argument("labels and truth of a scan differ in number");
  }
  PointCounts counts;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const bool kept = result[i] == Label::structure;
    if (truth[i] == SurfaceLabel::none) {
      ++counts.unjudged;
      counts.unjudged_kept += kept ? 1U : 0U;
    } else if (truth[i] == SurfaceLabel::structure) {
      ++(kept ? counts.true_positive : counts.false_negative);
    } else {
      ++(kept ? counts.false_positive : counts.true_negative);
      counts.dynamic += truth[i] == SurfaceLabel::dynamic ? 1U : 0U;
    }
  }
  return counts;
}

void add_surfaces(std::span<const Label> result, std::span<const SurfaceLabel> truth,
                  std::span<const std::uint16_t> surface, std::vector<SurfaceCounts>& by_surface) {
  if (result.size() != truth.size() || result.size() != surface.size()) {
    throw std::invalid_argument("labels, truth and surfaces of a scan differ in number");
  }
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (truth[i] == SurfaceLabel::none) continue;
    if (surface[i] >= by_surface.size()) by_surface.resize(std::size_t{surface[i]} + 1);
    SurfaceCounts& counts = by_surface[surface[i]];
    ++counts.points;
    counts.kept += result[i] == Label::structure ? 1U : 0U;
    counts.wrong += is_wrong(result[i], truth[i]) ? 1U : 0U;
  }
}

}  // namespace convexcut::evaluation
