// SPDX-License-Identifier: Apache-2.0
//
// What error frames say of a controller. Does not prove which of them a given controller sends.
#include "drivers/can/controller_state.hpp"

#include <gtest/gtest.h>

#include "tests/drivers/can/frames.hpp"

namespace convexcut::can {
namespace {

using test::make_frame;

CanFrame error_frame(std::uint32_t classes, std::string_view data = "0000000000000000") {
  CanFrame frame = make_frame(classes, data);
  frame.error = true;
  return frame;
}

constexpr std::array kAllStates{ControllerState::active, ControllerState::warning,
                                ControllerState::passive, ControllerState::bus_off};

TEST(ControllerState, FollowsTheControllersOwnReports) {
  struct Case {
    std::string_view data;
    ControllerState state;
  };
  constexpr std::array kCases{
      Case{"0004000000000000", ControllerState::warning},  // receiving
      Case{"0008000000000000", ControllerState::warning},  // transmitting
      Case{"0010000000000000", ControllerState::passive},
      Case{"0020000000000000", ControllerState::passive},
      Case{"0024000000000000", ControllerState::passive},  // the worse of both directions
      Case{"0040000000000000", ControllerState::active},
  };
  for (const Case& c : kCases) {
    for (const ControllerState before : kAllStates) {
      const ControllerReport report = next_state(before, error_frame(kControllerProblem, c.data));
      EXPECT_EQ(report.state, c.state) << c.data;
      EXPECT_EQ(report.changed, before != c.state) << c.data;
      EXPECT_FALSE(report.restarted || report.receive_overflow) << c.data;
    }
  }
}

TEST(ControllerState, BusOffIsWorseThanAllElseInTheSameFrame) {
  const ControllerReport report = next_state(
      ControllerState::warning, error_frame(kControllerProblem | kBusOff, "0040000000000000"));
  EXPECT_EQ(report.state, ControllerState::bus_off);
  EXPECT_TRUE(report.changed);
}

TEST(ControllerState, BusOffEndsWithTheRestart) {
  const ControllerReport report = next_state(ControllerState::bus_off, error_frame(kRestarted));
  EXPECT_EQ(report.state, ControllerState::active);
  EXPECT_TRUE(report.changed);
  EXPECT_TRUE(report.restarted);
}

TEST(ControllerState, AFrameFromTheBusEndsBusOffAndNothingElse) {
  const CanFrame frame = make_frame(0x021, "7FFF 0000 0000 0000");
  EXPECT_EQ(next_state(ControllerState::bus_off, frame).state, ControllerState::active);
  EXPECT_EQ(next_state(ControllerState::passive, frame).state, ControllerState::passive);
  EXPECT_EQ(next_state(ControllerState::warning, frame).state, ControllerState::warning);
  EXPECT_FALSE(next_state(ControllerState::passive, frame).changed);
}

TEST(ControllerState, TellsOverflowWithoutChangingTheState) {
  const ControllerReport report =
      next_state(ControllerState::passive, error_frame(kControllerProblem, "0001000000000000"));
  EXPECT_TRUE(report.receive_overflow);
  EXPECT_EQ(report.state, ControllerState::passive);
}

TEST(ControllerState, OtherClassesAndMissingDetailsChangeNothing) {
  for (const ControllerState before : kAllStates) {
    for (const std::uint32_t classes :
         {kTransmitTimeout, kTransceiverProblem, kNoAcknowledge, 0x080U, 0x200U}) {
      EXPECT_FALSE(next_state(before, error_frame(classes, "FFFFFFFFFFFFFFFF")).changed);
    }
    EXPECT_FALSE(next_state(before, error_frame(kControllerProblem, "FF")).changed);
  }
}

}  // namespace
}  // namespace convexcut::can
