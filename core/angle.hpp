// SPDX-License-Identifier: Apache-2.0
//
// Angles. Azimuths are integers, so that interpolation, wrapping and cutting are exact; everything
// else is a tagged double.
#pragma once

#include <compare>
#include <cstdint>
#include <numbers>

namespace convexcut {

struct Radians {
  double value = 0.0;
  friend constexpr auto operator<=>(Radians, Radians) = default;
};

struct Degrees {
  double value = 0.0;
  [[nodiscard]] constexpr Radians to_radians() const noexcept {
    return {value * (std::numbers::pi / 180.0)};
  }
  friend constexpr auto operator<=>(Degrees, Degrees) = default;
};

[[nodiscard]] constexpr Degrees to_degrees(Radians angle) noexcept {
  return {angle.value * (180.0 / std::numbers::pi)};
}

// A direction about the lidar's axis, clockwise seen from above as the sensor counts it, in whole
// microdegrees 0 … 359 999 999. Fine enough to hold 1/40 of the sensor's 0.01° without rounding.
class Azimuth {
 public:
  static constexpr std::int32_t kFullTurn = 360'000'000;
  static constexpr std::int32_t kPerCentidegree = 10'000;

  constexpr Azimuth() = default;

  // Any value; reduced to one turn.
  [[nodiscard]] static constexpr Azimuth from_microdegrees(std::int64_t microdegrees) noexcept {
    const std::int64_t reduced = microdegrees % kFullTurn;
    return Azimuth(static_cast<std::int32_t>(reduced < 0 ? reduced + kFullTurn : reduced));
  }
  // The wire's unit, 0.01°. 36000 occurs in real data and means 0.
  [[nodiscard]] static constexpr Azimuth from_centidegrees(std::int64_t centidegrees) noexcept {
    return from_microdegrees(centidegrees * kPerCentidegree);
  }
  [[nodiscard]] static constexpr Azimuth from_degrees(Degrees degrees) noexcept {
    const double scaled = degrees.value * 1e6;
    return from_microdegrees(static_cast<std::int64_t>(scaled + (scaled < 0 ? -0.5 : 0.5)));
  }

  [[nodiscard]] constexpr std::int32_t microdegrees() const noexcept { return microdegrees_; }
  [[nodiscard]] constexpr Degrees degrees() const noexcept { return {microdegrees_ * 1e-6}; }
  [[nodiscard]] constexpr Radians radians() const noexcept { return degrees().to_radians(); }

  // How far one turns clockwise from `from` to reach this, 0 … 359 999 999 microdegrees.
  [[nodiscard]] constexpr std::int32_t clockwise_from(Azimuth from) const noexcept {
    const std::int32_t delta = microdegrees_ - from.microdegrees_;
    return delta < 0 ? delta + kFullTurn : delta;
  }

  friend constexpr bool operator==(Azimuth, Azimuth) = default;

 private:
  explicit constexpr Azimuth(std::int32_t microdegrees) noexcept : microdegrees_(microdegrees) {}
  std::int32_t microdegrees_ = 0;
};

}  // namespace convexcut
