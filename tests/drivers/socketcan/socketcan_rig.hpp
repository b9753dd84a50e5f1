// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/socketcan/socketcan_source.hpp"
#include "tests/drivers/can/frames.hpp"
#include "tests/drivers/socketcan/vcan_interface.hpp"

namespace convexcut::socketcan::test {

using can::test::make_frame;
using live::LinkState;
using std::chrono::milliseconds;

struct Keeper final : can::FrameReceiver {
  void on_frame(const can::CanFrame& frame) noexcept override { frames.push_back(frame); }
  void flush() noexcept override { flushed_after.push_back(frames.size()); }
  std::vector<can::CanFrame> frames;
  std::vector<std::size_t> flushed_after;
};

inline can::CanFrame error_frame(std::uint32_t classes,
                                 std::string_view data = "0000000000000000") {
  can::CanFrame frame = make_frame(classes, data);
  frame.error = true;
  return frame;
}

class SocketCan : public testing::Test {
 protected:
  static SocketCanOptions options_for(const VcanInterface& interface) {
    return {.interface = interface.name(), .ids = {{0x021}, {0x034}, {0x19FF0032, true}}};
  }

  void add_up() {
    vcan.add();
    vcan.up();
  }

  // Runs the receive loop until `done`; a run-away stops after 20 s.
  static testing::AssertionResult run_until(SocketCanSource& source,
                                            const std::function<bool()>& done) {
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds{20};
    while (!done()) {
      if (std::chrono::steady_clock::now() > limit) {
        return testing::AssertionFailure() << "not within 20 s";
      }
      source.receive(milliseconds{20});
    }
    return testing::AssertionSuccess();
  }
  static testing::AssertionResult open(SocketCanSource& source) {
    return run_until(source, [&] { return source.link() == LinkState::open; });
  }

  VcanInterface vcan;
  Keeper keeper;
};

}  // namespace convexcut::socketcan::test
