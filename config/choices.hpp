// SPDX-License-Identifier: Apache-2.0
//
// The names that the enumerations of the configuration have in files and on the command line.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "config/config.hpp"

namespace convexcut::config {

// kNames<E>[i] is the name of the enumerator of value i.
template <class Enum>
inline constexpr std::array<std::string_view, 0> kNames{};

template <>
inline constexpr std::array<std::string_view, 5> kNames<LidarModel>{"auto", "hdl32e", "vlp16",
                                                                    "puck_hires", "vlp32c"};
template <>
inline constexpr std::array<std::string_view, 2> kNames<CutMode>{"revolution", "clock"};
template <>
inline constexpr std::array<std::string_view, 4> kNames<DualReturn>{"farthest", "last", "strongest",
                                                                    "both"};
template <>
inline constexpr std::array<std::string_view, 2> kNames<MountOrientation>{"imu", "fixed"};
template <>
inline constexpr std::array<std::string_view, 3> kNames<EncoderUse>{"off", "yaw", "orientation"};
template <>
inline constexpr std::array<std::string_view, 2> kNames<EncoderAxis>{"rotation", "tilt"};
template <>
inline constexpr std::array<std::string_view, 3> kNames<EncoderPreset>{"none", "cia402_position",
                                                                       "cia402_position_sdo"};
template <>
inline constexpr std::array<std::string_view, 2> kNames<ByteOrder>{"intel", "motorola"};
template <>
inline constexpr std::array<std::string_view, 2> kNames<Method>{"paper", "robust"};
template <>
inline constexpr std::array<std::string_view, 6> kNames<SimdPath>{"auto", "avx512", "avx2",
                                                                  "sse4", "neon",   "baseline"};
template <>
inline constexpr std::array<std::string_view, 4> kNames<LogLevel>{"error", "warning", "info",
                                                                  "debug"};
template <>
inline constexpr std::array<std::string_view, 3> kNames<Realtime>{"auto", "on", "off"};
template <>
inline constexpr std::array<std::string_view, 2> kNames<Reliability>{"reliable", "best_effort"};

static_assert(kNames<LidarModel>[static_cast<std::size_t>(LidarModel::vlp32c)] == "vlp32c");
static_assert(kNames<CutMode>[static_cast<std::size_t>(CutMode::clock)] == "clock");
static_assert(kNames<DualReturn>[static_cast<std::size_t>(DualReturn::both)] == "both");
static_assert(kNames<MountOrientation>[static_cast<std::size_t>(MountOrientation::fixed)] ==
              "fixed");
static_assert(kNames<EncoderUse>[static_cast<std::size_t>(EncoderUse::orientation)] ==
              "orientation");
static_assert(kNames<EncoderAxis>[static_cast<std::size_t>(EncoderAxis::tilt)] == "tilt");
static_assert(kNames<EncoderPreset>[static_cast<std::size_t>(EncoderPreset::cia402_position_sdo)] ==
              "cia402_position_sdo");
static_assert(kNames<ByteOrder>[static_cast<std::size_t>(ByteOrder::motorola)] == "motorola");
static_assert(kNames<Method>[static_cast<std::size_t>(Method::robust)] == "robust");
static_assert(kNames<LogLevel>[static_cast<std::size_t>(LogLevel::debug)] == "debug");
static_assert(kNames<Realtime>[static_cast<std::size_t>(Realtime::off)] == "off");
static_assert(kNames<Reliability>[static_cast<std::size_t>(Reliability::best_effort)] ==
              "best_effort");

template <class Enum>
[[nodiscard]] constexpr std::string_view name_of(Enum value) noexcept {
  return kNames<Enum>[static_cast<std::size_t>(value)];
}

}  // namespace convexcut::config
