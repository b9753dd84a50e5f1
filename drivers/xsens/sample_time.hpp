// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/xsens/mt_measurement.hpp"

namespace convexcut::xsens {

inline constexpr std::uint32_t kSampleTicksPerSecond = 10'000;

// The sample time in ticks of 100 µs, modulo 2^32. With SampleTimeCoarse (seconds) beside it, Fine
// counts on in some firmwares and only within the second in others; seconds from one and the rest
// from the other is right for both (as in the Xsens SDK, packetstamper.cpp).
[[nodiscard]] constexpr std::optional<std::uint32_t> sample_time_ticks(
    const MtMeasurement& m) noexcept {
  if (!m.has(MtItem::sample_time_fine)) return std::nullopt;
  if (!m.has(MtItem::sample_time_coarse)) return m.sample_time_fine;
  return static_cast<std::uint32_t>(std::uint64_t{m.sample_time_coarse} * kSampleTicksPerSecond +
                                    m.sample_time_fine % kSampleTicksPerSecond);
}

}  // namespace convexcut::xsens
