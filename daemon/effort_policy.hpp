// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/time.hpp"
#include "daemon/pipeline/effort.hpp"

namespace convexcut::daemon {

// Decides how much is computed for the next scan from how long the last ones took: one step less
// after kOverruns scans in a row that took longer than they had, one step more after a calm time in
// which one step more would have taken less than kCalmPercent of it. When a step back up turns out
// to be too much, the next is tried after twice the calm time. Design note:
// docs/design/realtime.md.
//
// Pure: reads no clock, and the same observations give the same decisions. One thread. RT.
class EffortPolicy {
 public:
  static constexpr std::uint32_t kOverruns = 2;
  static constexpr int kCalmPercent = 60;
  static constexpr std::uint32_t kShortestCalm = 20;  // scans: 2 s
  static constexpr std::uint32_t kLongestCalm = 640;  // 64 s

  // A scan at the present effort.
  struct Pace {
    Duration used;                      // until its labels were there
    Duration budget;                    // > 0: what it had for that
    Duration learning{0};               // after the labels of a scan that is learnt from
    Duration period = Duration::max();  // > 0: for all of it
    bool learns_first = false;          // at full effort labels wait for the learning
  };
  void observe(const Pace& pace) noexcept;

  [[nodiscard]] Effort effort() const noexcept { return effort_; }

 private:
  [[nodiscard]] bool is_overrun(const Pace& pace) const noexcept;
  [[nodiscard]] bool is_calm(const Pace& pace) const noexcept;
  void reduce() noexcept;
  void restore() noexcept;

  Effort effort_ = Effort::full;
  std::uint32_t overruns_ = 0;  // in a row
  std::uint32_t calm_ = 0;      // in a row
  std::uint32_t calm_wanted_ = kShortestCalm;
  bool restored_ = false;             // the last change was a step up
  std::uint32_t since_restored_ = 0;  // scans
};

}  // namespace convexcut::daemon
