// SPDX-License-Identifier: Apache-2.0
//
// The link of a bus: interfaces that are missing, down or gone, and what the controller reports.
// Does not prove what a real controller reports when: a virtual bus has no errors of its own, so
// error frames are sent by another node.
#include <cerrno>

#include "drivers/live/retry_pause.hpp"
#include "tests/drivers/socketcan/socketcan_rig.hpp"

namespace convexcut::socketcan {
namespace {

using can::test::make_frame;
using live::LinkState;
using std::chrono::milliseconds;
using test::BusNode;
using test::error_frame;
using test::Keeper;
using test::SocketCan;

TEST_F(SocketCan, BusOffIsAnErrorOfTheLinkUntilTheRestart) {
  CONVEXCUT_NEEDS_VCAN();
  add_up();
  SocketCanSource source(options_for(vcan), keeper);
  ASSERT_TRUE(open(source));
  const BusNode node(vcan);
  node.send(error_frame(can::kControllerProblem, "0020000000000000"));
  ASSERT_TRUE(run_until(source, [&] { return keeper.frames.size() >= 1; }));
  EXPECT_EQ(source.controller(), can::ControllerState::passive);
  EXPECT_EQ(source.link(), LinkState::open);

  node.send(error_frame(can::kBusOff));
  ASSERT_TRUE(run_until(source, [&] { return source.link() == LinkState::error; }));
  EXPECT_EQ(source.controller(), can::ControllerState::bus_off);

  node.send(error_frame(can::kRestarted));
  ASSERT_TRUE(run_until(source, [&] { return source.link() == LinkState::open; }));
  node.send(error_frame(can::kControllerProblem, "0001000000000000"));
  ASSERT_TRUE(run_until(source, [&] { return keeper.frames.size() >= 4; }));
  EXPECT_EQ(source.counters().error_frames.value(), 4U);
  EXPECT_EQ(source.counters().error_passive.value(), 1U);
  EXPECT_EQ(source.counters().bus_off.value(), 1U);
  EXPECT_EQ(source.counters().restarts.value(), 1U);
  EXPECT_EQ(source.counters().controller_overflows.value(), 1U);
  EXPECT_EQ(source.counters().opened.value(), 1U) << "the socket stays open";
}

TEST_F(SocketCan, FramesFromTheBusEndBusOff) {
  CONVEXCUT_NEEDS_VCAN();
  add_up();
  SocketCanSource source(options_for(vcan), keeper);
  ASSERT_TRUE(open(source));
  const BusNode node(vcan);
  node.send(error_frame(can::kBusOff));
  ASSERT_TRUE(run_until(source, [&] { return source.link() == LinkState::error; }));
  node.send(make_frame(0x021, "00"));
  ASSERT_TRUE(run_until(source, [&] { return source.link() == LinkState::open; }));
}

TEST_F(SocketCan, FloodingBusErrorsAreNotReceived) {
  CONVEXCUT_NEEDS_VCAN();
  add_up();
  SocketCanSource source(options_for(vcan), keeper);
  ASSERT_TRUE(open(source));
  const BusNode node(vcan);
  constexpr std::uint32_t kBusError = 0x080;
  node.send(error_frame(kBusError));
  node.send(make_frame(0x021, "00"));
  ASSERT_TRUE(run_until(source, [&] { return !keeper.frames.empty(); }));
  EXPECT_FALSE(keeper.frames.front().error);
}

TEST_F(SocketCan, WaitsForAnInterfaceThatIsMissingAtTheStart) {
  CONVEXCUT_NEEDS_VCAN();
  SocketCanSource source(options_for(vcan), keeper);
  source.receive(milliseconds{0});
  EXPECT_EQ(source.link(), LinkState::closed);
  EXPECT_EQ(source.last_error(), ENODEV);
  add_up();
  ASSERT_TRUE(open(source));
  EXPECT_EQ(source.last_error(), 0);
  BusNode(vcan).send(make_frame(0x021, "00"));
  EXPECT_TRUE(run_until(source, [&] { return keeper.frames.size() == 1; }));
}

TEST_F(SocketCan, WaitsForAnInterfaceThatIsDownAtTheStart) {
  CONVEXCUT_NEEDS_VCAN();
  vcan.add();
  SocketCanSource source(options_for(vcan), keeper);
  source.receive(milliseconds{0});
  EXPECT_EQ(source.link(), LinkState::closed);
  EXPECT_EQ(source.last_error(), ENETDOWN);
  vcan.up();
  ASSERT_TRUE(open(source));
  BusNode(vcan).send(make_frame(0x021, "00"));
  EXPECT_TRUE(run_until(source, [&] { return keeper.frames.size() == 1; }));
}

TEST_F(SocketCan, SurvivesDownAndUpAndLosesNoFrameFromBefore) {
  CONVEXCUT_NEEDS_VCAN();
  add_up();
  SocketCanSource source(options_for(vcan), keeper);
  ASSERT_TRUE(open(source));
  {
    const BusNode node(vcan);
    for (unsigned i = 0; i < 100; ++i) node.send(make_frame(0x021, "00"));
  }
  vcan.down();  // before any of them is read
  ASSERT_TRUE(run_until(source, [&] { return source.link() == LinkState::closed; }));
  EXPECT_EQ(source.last_error(), ENETDOWN);
  EXPECT_EQ(keeper.frames.size(), 100U);
  EXPECT_EQ(source.counters().closed.value(), 1U);

  vcan.up();
  ASSERT_TRUE(open(source));
  BusNode(vcan).send(make_frame(0x034, "01"));
  ASSERT_TRUE(run_until(source, [&] { return keeper.frames.size() == 101; }));
  EXPECT_EQ(keeper.frames.back().id, 0x034U);
}

TEST_F(SocketCan, SurvivesAnInterfaceThatIsRemovedAndAddedAgain) {
  CONVEXCUT_NEEDS_VCAN();
  add_up();
  SocketCanSource source(options_for(vcan), keeper);
  ASSERT_TRUE(open(source));
  vcan.remove();
  ASSERT_TRUE(run_until(source, [&] { return source.link() == LinkState::closed; }));
  ASSERT_TRUE(run_until(source, [&] { return source.last_error() == ENODEV; }));
  add_up();
  ASSERT_TRUE(open(source));
  BusNode(vcan).send(make_frame(0x021, "00"));
  EXPECT_TRUE(run_until(source, [&] { return keeper.frames.size() == 1; }));
}

TEST(SocketCanWithoutInterface, IsTriedAFewTimesASecondOnly) {
  Keeper keeper;
  SocketCanSource source({.interface = "no-such-can", .ids = {{0x021}}}, keeper);
  const auto start = std::chrono::steady_clock::now();
  auto took = std::chrono::steady_clock::duration::zero();
  while (took < 2 * live::RetryPause::kPause) {
    source.receive(std::chrono::microseconds{300});
    took = std::chrono::steady_clock::now() - start;
  }
  EXPECT_EQ(source.link(), LinkState::closed);
  EXPECT_NE(source.last_error(), 0);
  const auto allowed = static_cast<std::uint64_t>(took / live::RetryPause::kPause) + 1;
  EXPECT_LE(source.counters().open_attempts.value(), allowed);
  EXPECT_GE(source.counters().open_attempts.value(), 2U);
  EXPECT_EQ(source.counters().opened.value(), 0U);
}

TEST(SocketCanWithoutInterface, NamesThatNoInterfaceCanHaveAreMissingInterfaces) {
  for (const char* name : {"", "an_interface_name_that_is_too_long"}) {
    Keeper keeper;
    SocketCanSource source({.interface = name, .ids = {{0x021}}}, keeper);
    source.receive(milliseconds{0});
    EXPECT_EQ(source.link(), LinkState::closed);
    EXPECT_TRUE(source.last_error() == ENODEV || source.last_error() == EAFNOSUPPORT)
        << source.last_error();
  }
}

}  // namespace
}  // namespace convexcut::socketcan
