// SPDX-License-Identifier: Apache-2.0
//
// Which simulated return each point of a result is. A point is found by its firing time and its
// ring; its range is the proof. The result's clock is an estimate (of the sensor's clock by arrival
// times), so a scan's firings are off by a time that is nearly constant over a revolution: it is
// found by trying how many firings the scan has to be shifted until ranges agree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/time.hpp"
#include "replay/pcd_reader.hpp"
#include "replay/simulation/truth/truth_reader.hpp"

namespace convexcut::evaluation {

// The truth of a scan's points.
struct MatchedTruth {
  std::vector<simulation::SurfaceLabel> label;  // none also where a point was not found
  std::vector<std::uint16_t> surface;           // kNoSurface then
  std::size_t unmatched = 0;                    // points that were not found
  Duration offset{};                            // of the result's clock from the truth's
};

class TruthMatcher {
 public:
  // The truth must outlive it.
  explicit TruthMatcher(const simulation::TruthReader& truth) : truth_(&truth) {}

  // False when the ranges of less than 90 % of the points agree with the truth at any offset up to
  // 20 ms: truth and result do not belong together. The cloud has ring and time; points in any
  // frame with the lidar as origin. A scan begins the search with the offset of the one before.
  [[nodiscard]] bool match(HostTime stamp, const replay::PcdCloud& cloud, MatchedTruth& out);

 private:
  struct Place {      // of a point
    HostTime firing;  // of its first laser, by the result's clock
    std::size_t laser;
    double range_m;
  };
  [[nodiscard]] static std::optional<Place> place_of(HostTime stamp, const replay::PcdCloud& cloud,
                                                     std::size_t point);
  // The echo of the firing that has the point's range.
  [[nodiscard]] std::optional<simulation::SimulatedReturn> return_of(std::size_t firing,
                                                                     const Place& place) const;
  // The nearest firing to the point's time, less an offset.
  [[nodiscard]] std::size_t firing_near(const Place& place, Duration offset) const;
  [[nodiscard]] double agreement(const std::vector<Place>& sample, Duration offset) const;
  [[nodiscard]] std::optional<Duration> find_offset(const std::vector<Place>& sample) const;
  // From the matches of a sample: half a firing's worth of rounding is taken out.
  [[nodiscard]] Duration refine(const std::vector<Place>& sample, Duration offset) const;

  const simulation::TruthReader* truth_;
  Duration offset_{0};
};

}  // namespace convexcut::evaluation
