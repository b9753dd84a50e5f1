// SPDX-License-Identifier: Apache-2.0
#include "replay/evaluation/truth_matching.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "drivers/velodyne/model.hpp"

namespace convexcut::evaluation {
namespace {

using simulation::SimulatedReturn;

constexpr int kMostShift = 434;  // firings: 20 ms
constexpr std::size_t kSample = 400;
constexpr double kLeastAgreement = 0.9;
// Ranges on the wire are 2 mm apart; a point's coordinates are rounded to floats.
constexpr double kRangeProof_m = 0.0009;

const velodyne::Model& model() noexcept {
  return velodyne::model_of(velodyne::ModelId::hdl32e);  // what is simulated
}

[[nodiscard]] Duration firing_period() noexcept { return Duration{model().firing_period_ns}; }

}  // namespace

std::optional<TruthMatcher::Place> TruthMatcher::place_of(HostTime stamp,
                                                          const replay::PcdCloud& cloud,
                                                          std::size_t point) {
  const auto& rings = model().ring;
  const auto laser = static_cast<std::size_t>(
      std::find(rings.begin(), rings.end(), cloud.ring[point]) - rings.begin());
  if (laser >= model().lasers) return std::nullopt;
  const Duration after_first{model().laser_time_ns(laser)};
  const Vec3 p(static_cast<double>(cloud.x[point]), static_cast<double>(cloud.y[point]),
               static_cast<double>(cloud.z[point]));
  return Place{stamp + Duration{cloud.time_ns[point]} - after_first, laser, p.norm()};
}

std::optional<SimulatedReturn> TruthMatcher::return_of(std::size_t firing,
                                                       const Place& place) const {
  if (firing >= truth_->firings()) return std::nullopt;
  const simulation::TrueFiring candidates = truth_->firing(firing);
  for (std::size_t echo = 0; echo < candidates.echoes(); ++echo) {
    const SimulatedReturn found = candidates.at(echo, place.laser);
    if (std::abs(found.range_2mm * 0.002 - place.range_m) <= kRangeProof_m) return found;
  }
  return std::nullopt;
}

std::size_t TruthMatcher::firing_near(const Place& place, Duration offset) const {
  return truth_->firing_at(place.firing - offset + firing_period() / 2);
}

double TruthMatcher::agreement(const std::vector<Place>& sample, Duration offset) const {
  const auto agreeing = std::ranges::count_if(sample, [&](const Place& place) {
    return return_of(firing_near(place, offset), place).has_value();
  });
  return static_cast<double>(agreeing) / static_cast<double>(sample.size());
}

std::optional<Duration> TruthMatcher::find_offset(const std::vector<Place>& sample) const {
  std::optional<Duration> best;
  double most = kLeastAgreement;
  for (int shift = 0; shift <= kMostShift; ++shift) {
    for (const int signed_shift : {shift, -shift}) {
      const Duration offset = offset_ + signed_shift * firing_period();
      const double agreeing = agreement(sample, offset);
      if (agreeing < most) continue;
      most = agreeing;
      best = offset;
    }
    // Neighbouring firings share some ranges by chance, few scans nearly all of them.
    if (best && most > 0.98) break;
  }
  return best;
}

Duration TruthMatcher::refine(const std::vector<Place>& sample, Duration offset) const {
  Duration sum{0};
  std::int64_t count = 0;
  for (const Place& place : sample) {
    const std::size_t firing = firing_near(place, offset);
    if (!return_of(firing, place)) continue;
    sum += place.firing - truth_->firing(firing).time() - offset;
    ++count;
  }
  return count == 0 ? offset : offset + sum / count;
}

bool TruthMatcher::match(HostTime stamp, const replay::PcdCloud& cloud, MatchedTruth& out) {
  const std::size_t points = cloud.x.size();
  std::vector<Place> sample;
  for (std::size_t k = 0; k < kSample && points > 0; ++k) {
    if (const auto place = place_of(stamp, cloud, k * points / kSample)) sample.push_back(*place);
  }
  out.label.assign(points, simulation::SurfaceLabel::none);
  out.surface.assign(points, simulation::kNoSurface);
  out.unmatched = 0;
  if (points == 0) return true;
  const auto offset = sample.empty() ? std::nullopt : find_offset(sample);
  if (!offset) return false;
  offset_ = refine(sample, *offset);
  out.offset = offset_;
  for (std::size_t i = 0; i < points; ++i) {
    const auto place = place_of(stamp, cloud, i);
    if (!place) {
      ++out.unmatched;
      continue;
    }
    // The scan's clock may drift by a part of a firing within it.
    const std::size_t nearest = firing_near(*place, offset_);
    std::optional<SimulatedReturn> found;
    for (const std::size_t firing : {nearest, nearest + 1, nearest - 1}) {
      found = return_of(firing, *place);
      if (found) break;
    }
    if (!found) {
      ++out.unmatched;
      continue;
    }
    out.label[i] = found->label;
    out.surface[i] = found->surface;
  }
  return static_cast<double>(out.unmatched) <=
         (1.0 - kLeastAgreement) * static_cast<double>(points);
}

}  // namespace convexcut::evaluation
