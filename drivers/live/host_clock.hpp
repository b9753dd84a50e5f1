// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <ctime>

#include "core/time.hpp"

namespace convexcut::live {

using Steady = std::chrono::steady_clock;  // for waiting; stamps are of the host's clock

[[nodiscard]] inline HostTime to_host_time(const std::timespec& time) noexcept {
  return HostTime{std::chrono::seconds{time.tv_sec} + std::chrono::nanoseconds{time.tv_nsec}};
}

[[nodiscard]] inline std::timespec to_timespec(Duration span) noexcept {
  const auto whole = std::chrono::floor<std::chrono::seconds>(span);
  return {whole.count(), (span - whole).count()};
}

// Now, in the clock that the kernel stamps datagrams with.
[[nodiscard]] inline HostTime host_now() noexcept {
  std::timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return to_host_time(now);
}

}  // namespace convexcut::live
