// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/controller_state.hpp"

#include "drivers/wire.hpp"

namespace convexcut::can {
namespace {

// Of an error frame of class kControllerProblem: what is wrong, as bits.
constexpr std::size_t kControllerOffset = 1;
constexpr std::uint8_t kReceiveOverflow = 0x01;
constexpr std::uint8_t kWarning = 0x04 | 0x08;  // of receiving, of transmitting
constexpr std::uint8_t kPassive = 0x10 | 0x20;
constexpr std::uint8_t kActive = 0x40;
static_assert(kControllerOffset < kMaxClassicLength);

[[nodiscard]] ControllerState controller_state(ControllerState state, std::uint8_t bits) noexcept {
  if ((bits & kPassive) != 0) return ControllerState::passive;
  if ((bits & kWarning) != 0) return ControllerState::warning;
  if ((bits & kActive) != 0) return ControllerState::active;
  return state;
}

}  // namespace

ControllerReport next_state(ControllerState state, const CanFrame& frame) noexcept {
  ControllerReport report{.state = state};
  if (!frame.error) {
    if (state == ControllerState::bus_off) report.state = ControllerState::active;
  } else {
    if ((frame.id & kRestarted) != 0) {
      report.restarted = true;
      report.state = ControllerState::active;
    }
    if ((frame.id & kControllerProblem) != 0 && frame.length > kControllerOffset) {
      const std::uint8_t bits = wire::load_u8(frame.payload(), kControllerOffset);
      report.receive_overflow = (bits & kReceiveOverflow) != 0;
      report.state = controller_state(report.state, bits);
    }
    if ((frame.id & kBusOff) != 0) report.state = ControllerState::bus_off;
  }
  report.changed = report.state != state;
  return report;
}

}  // namespace convexcut::can
