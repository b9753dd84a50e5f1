// SPDX-License-Identifier: Apache-2.0
//
// Offset and skew between two clocks from one-way delays. An observation is a sensor time and the
// host's stamp of its arrival: host − sensor = true offset + a delay that is never negative. The
// true offset therefore runs along the lower envelope of the observations.
//
// Of each window of sensor time only the lowest observation is kept. The skew is the slope of that
// edge of their lower convex hull that lies under the middle: of all lines below every observation
// it is the closest (S. Moon, P. Skelly, D. Towsley: "Estimation and removal of clock skew from
// network delay measurements", INFOCOM 1999; L. Zhang, Z. Liu, C. H. Xia: "Clock synchronization
// algorithms for network measurements", INFOCOM 2002).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/time.hpp"

namespace convexcut {

struct ClockMappingOptions {
  Duration window = std::chrono::seconds{1};     // of sensor time; > 0
  Duration min_span = std::chrono::seconds{10};  // of the minima before a skew is taken from them
  double max_skew_ppm = 200.0;                   // crystals are within; bounds a wrong estimate
  // An observation below the envelope by more, or all of three windows above it by more, is a step
  // of one of the clocks.
  Duration step = std::chrono::milliseconds{250};
};

struct ClockState {
  Duration offset{};          // host − sensor at the newest observation
  double skew_ppm = 0.0;      // by which the host's clock runs faster than the sensor's
  Duration jitter{};          // root mean square of the delays above the envelope
  std::uint64_t samples = 0;  // since construction or reset
  std::uint32_t steps = 0;    // steps of either clock since then; each starts the estimate anew
  bool locked = false;        // the skew comes from at least min_span since the last step
};

// The estimator behind ClockMapping; times are offsets from each clock's own zero, within ±100
// years. Memory is fixed; an observation costs a few comparisons, the first of a window a hull of
// 64 points.
class LowerEnvelope {
 public:
  explicit LowerEnvelope(const ClockMappingOptions& options) noexcept : options_(options) {}

  void observe(Duration sensor, Duration host) noexcept;
  // The host's time of `sensor`. Without any observation: `sensor` itself.
  [[nodiscard]] Duration to_host(Duration sensor) const noexcept;
  [[nodiscard]] ClockState state() const noexcept;
  void reset() noexcept { *this = LowerEnvelope(options_); }

 private:
  static constexpr std::size_t kWindows = 64;

  struct Observation {
    Duration sensor{};
    Duration offset{};  // host − sensor
  };
  struct Window {
    Duration start{};
    Observation lowest;
    double squared_delays = 0.0;  // ns², above the envelope
    std::uint64_t samples = 0;
  };
  struct Line {
    Observation through;
    double skew = 0.0;
    [[nodiscard]] Duration at(Duration sensor) const noexcept;
    // How far `o` lies above the line.
    [[nodiscard]] Duration below(const Observation& o) const noexcept {
      return o.offset - at(o.sensor);
    }
  };

  void restart(const Observation& first) noexcept;
  void slew(Duration sensor) noexcept;
  void add_to_window(const Observation& o, Duration delay) noexcept;
  // False when the windows say that a clock was stepped.
  [[nodiscard]] bool close_window(Duration now) noexcept;
  void fit() noexcept;
  void move_to(const Line& estimate) noexcept;
  [[nodiscard]] const Window& closed(std::size_t i) const noexcept {
    return closed_[(oldest_ + i) % kWindows];
  }
  [[nodiscard]] double slope_under_the_middle() const noexcept;

  ClockMappingOptions options_;
  std::array<Window, kWindows> closed_{};  // a ring: oldest_, closed_count_
  std::size_t oldest_ = 0;
  std::size_t closed_count_ = 0;
  Window open_;
  Line estimate_;
  Duration correction_{};  // of the estimate, towards what was told before; fades
  Duration newest_{};
  std::uint64_t samples_ = 0;
  std::uint32_t steps_ = 0;
  std::uint32_t windows_above_ = 0;
  bool locked_ = false;
};

}  // namespace convexcut
