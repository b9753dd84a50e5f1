// SPDX-License-Identifier: Apache-2.0
//
// What a CAN controller says of itself in error frames (linux/can/error.h). The thresholds are
// those of ISO 11898-1: warning at 96 errors, passive at 128, bus off beyond 255.
#pragma once

#include <cstdint>

#include "drivers/can/can_frame.hpp"

namespace convexcut::can {

// The classes of error frames, bits of their id.
inline constexpr std::uint32_t kTransmitTimeout = 0x001;
inline constexpr std::uint32_t kControllerProblem = 0x004;
inline constexpr std::uint32_t kTransceiverProblem = 0x010;
inline constexpr std::uint32_t kNoAcknowledge = 0x020;
inline constexpr std::uint32_t kBusOff = 0x040;
inline constexpr std::uint32_t kRestarted = 0x100;

enum class ControllerState : std::uint8_t {
  active,   // takes part in the traffic
  warning,  // as active, but errors are frequent
  passive,  // receives, and may no longer mark errors on the bus
  bus_off,  // silent: receives nothing until it is restarted
};

struct ControllerReport {
  ControllerState state = ControllerState::active;
  bool changed = false;
  bool restarted = false;
  bool receive_overflow = false;  // the controller has lost frames before the kernel saw them
};

// The state after `frame`. A frame from the bus ends bus-off, too: a controller that is off
// receives none, and its restart may have been reported before anybody listened.
[[nodiscard]] ControllerReport next_state(ControllerState state, const CanFrame& frame) noexcept;

}  // namespace convexcut::can
