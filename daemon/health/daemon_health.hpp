// SPDX-License-Identifier: Apache-2.0
//
// How the daemon as a whole is doing, and why. Rules and state table: docs/design/health.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.hpp"
#include "daemon/health/counters.hpp"
#include "daemon/health/source_health.hpp"

namespace convexcut::daemon {

enum class DaemonState : std::uint8_t {
  starting,  // a source is not there yet, and need not be
  ok,
  degraded,  // results come, with something missing
  faulty,    // no results, or results of nothing
};
inline constexpr int kDaemonStates = 4;

[[nodiscard]] std::string_view name_of(DaemonState state) noexcept;

enum class Severity : std::uint8_t { degraded, faulty };

// One thing that is wrong, in a few words without numbers: "lidar stale".
struct Reason {
  Severity severity = Severity::degraded;
  std::string text;
  friend bool operator==(const Reason&, const Reason&) = default;
};

struct DaemonLimits {
  Duration start_grace = std::chrono::seconds{10};   // sources may be switched on later than we
  Duration silent_after = std::chrono::seconds{1};   // without any result, empty ones included
  double lossy_share = 0.01;                         // of a source's input never came
  Duration loss_hold = std::chrono::seconds{10};     // that a loss keeps the daemon degraded
  Duration recover_after = std::chrono::seconds{2};  // without the reason of the present state
};

// The transition, free of time and memory. `worst`: of the reasons at hand; `calm`: for how long
// there has been none as bad as the present state.
struct DaemonObservation {
  bool still_starting = false;  // required sources are missing, within start_grace
  std::optional<Severity> worst;
  Duration calm{};
};
[[nodiscard]] DaemonState next_state(DaemonState before, const DaemonObservation& now,
                                     const DaemonLimits& limits) noexcept;

// One thread.
class DaemonMonitor {
 public:
  explicit DaemonMonitor(const DaemonLimits& limits = {}) noexcept : limits_(limits) {}

  // `others`: what only the caller can know, e.g. memory that could not be locked.
  void update(std::span<const SourceHealth> sources, const HealthCounters& totals,
              std::span<const Reason> others, SteadyTime now);

  [[nodiscard]] DaemonState state() const noexcept { return state_; }
  // Worst first, in a fixed order otherwise; empty while state() is ok. A state that is only held
  // by recover_after keeps the reasons that it had.
  [[nodiscard]] const std::vector<Reason>& reasons() const noexcept { return reasons_; }

 private:
  [[nodiscard]] bool still_starting(std::span<const SourceHealth> sources, SteadyTime now) const;
  [[nodiscard]] std::vector<Reason> find_reasons(std::span<const SourceHealth> sources,
                                                 bool starting, SteadyTime now) const;
  void watch_results(const HealthCounters& totals, SteadyTime now);
  void watch_losses(const HealthCounters& totals, SteadyTime now);

  DaemonLimits limits_;
  DaemonState state_ = DaemonState::starting;
  std::vector<Reason> reasons_;
  bool was_up_ = false;  // all required sources have streamed once
  std::optional<SteadyTime> start_;
  SteadyTime last_bad_{};     // when there was a reason as bad as the state
  SteadyTime last_result_{};  // when one was seen published
  HealthCounters totals_;
  std::vector<std::optional<SteadyTime>> last_losses_;  // by counter
};

}  // namespace convexcut::daemon
