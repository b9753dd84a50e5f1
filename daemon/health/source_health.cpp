// SPDX-License-Identifier: Apache-2.0
#include "daemon/health/source_health.hpp"

#include <cerrno>

namespace convexcut::daemon {
namespace {

constexpr Duration kRateWindow = std::chrono::seconds{1};

// Errors of opening that another attempt will not cure: somebody has to do something.
bool needs_somebody(int error) noexcept {
  switch (error) {
    case EACCES:
    case EPERM:
    case EADDRINUSE:
    case EBUSY:
    case EINVAL:
    case ENOTTY:
    case EISDIR:
    case EAFNOSUPPORT:
    case EPROTONOSUPPORT:
      return true;
    default:
      return false;
  }
}

bool mostly_invalid(SourceState before, const SourceObservation& now,
                    const SourceLimits& limits) noexcept {
  if (now.invalid_hz < limits.least_invalid_hz) return false;
  const double share = before == SourceState::faulty ? limits.recovered_share : limits.faulty_share;
  return now.invalid_hz > share * (now.valid_hz + now.invalid_hz);
}

// The link is open and what comes makes sense.
SourceState open_state(SourceState before, const SourceObservation& now,
                       const SourceLimits& limits) noexcept {
  const bool fresh = now.since_valid && *now.since_valid <= limits.stale_after;
  switch (before) {
    case SourceState::absent:
    case SourceState::waiting:
      return fresh ? SourceState::streaming : SourceState::waiting;
    case SourceState::streaming:
      return fresh ? SourceState::streaming : SourceState::stale;
    case SourceState::stale:
      return fresh && now.valid_for >= limits.recover_after ? SourceState::streaming
                                                            : SourceState::stale;
    case SourceState::faulty:
      if (!fresh) return SourceState::waiting;
      return now.valid_for >= limits.recover_after ? SourceState::streaming : SourceState::faulty;
  }
  return before;
}

// Per second, of what was counted in `span`. A restarted counter counts from zero.
double rate_hz(std::uint64_t from, std::uint64_t to, Duration span) noexcept {
  const std::uint64_t count = to >= from ? to - from : to;
  return static_cast<double>(count) / std::chrono::duration<double>(span).count();
}

}  // namespace

std::string_view name_of(SourceState state) noexcept {
  switch (state) {
    case SourceState::absent:
      return "absent";
    case SourceState::waiting:
      return "waiting";
    case SourceState::streaming:
      return "streaming";
    case SourceState::stale:
      return "stale";
    case SourceState::faulty:
      return "faulty";
  }
  return "absent";
}

SourceState next_state(SourceState before, const SourceObservation& now,
                       const SourceLimits& limits) noexcept {
  switch (now.link) {
    case live::LinkState::error:
      return SourceState::faulty;
    case live::LinkState::closed:
      return needs_somebody(now.last_error) ? SourceState::faulty : SourceState::absent;
    case live::LinkState::open:
      break;
  }
  if (mostly_invalid(before, now, limits)) return SourceState::faulty;
  return open_state(before, now, limits);
}

const SourceHealth& SourceMonitor::update(const SourceReading& reading, SteadyTime now) {
  const bool valid_came = reading.valid != health_.reading.valid;
  health_.reading = reading;
  if (valid_came) {
    if (!last_valid_ || now - *last_valid_ > limits_.stale_after) valid_since_ = now;
    last_valid_ = now;
  }
  measure_rates(now);
  if (last_valid_) health_.since_valid = now - *last_valid_;

  SourceObservation observation;
  observation.link = reading.link;
  observation.last_error = reading.last_error;
  observation.since_valid = health_.since_valid;
  observation.valid_for = last_valid_ ? *last_valid_ - valid_since_ : Duration::zero();
  observation.valid_hz = health_.valid_hz;
  observation.invalid_hz = health_.invalid_hz;
  health_.state = next_state(health_.state, observation, limits_);
  return health_;
}

void SourceMonitor::measure_rates(SteadyTime now) noexcept {
  if (window_start_ && now - *window_start_ < kRateWindow) return;
  if (window_start_) {
    const Duration span = now - *window_start_;
    health_.valid_hz = rate_hz(window_.valid, health_.reading.valid, span);
    health_.invalid_hz = rate_hz(window_.invalid, health_.reading.invalid, span);
    health_.lost_hz = rate_hz(window_.lost, health_.reading.lost, span);
  }
  window_start_ = now;
  window_ = health_.reading;
}

}  // namespace convexcut::daemon
