// SPDX-License-Identifier: Apache-2.0
//
// Virtual CAN interfaces for tests: a kernel with CAN, the module vcan, and root are needed.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/can/can_frame.hpp"
#include "drivers/live/file_descriptor.hpp"

namespace convexcut::socketcan::test {

// Why there can be none here; empty: there can.
[[nodiscard]] const std::string& why_no_vcan();

// A virtual CAN interface of its own for a test, removed at the end. Starts absent.
class VcanInterface {
 public:
  VcanInterface();
  ~VcanInterface() { remove(); }
  VcanInterface(const VcanInterface&) = delete;
  VcanInterface& operator=(const VcanInterface&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  void add();  // down, and large enough for FD frames
  void up();
  void down();
  void remove();
  // Frames that the kernel lost before any socket: the backlog of a busy host was full.
  [[nodiscard]] std::uint64_t lost_before_sockets() const;

 private:
  std::string name_;
  bool there_ = false;
};

// Another node of the bus.
class BusNode {
 public:
  explicit BusNode(const VcanInterface& interface);
  // Any frame, error frames among them; the interface is up.
  void send(const can::CanFrame& frame) const;

 private:
  live::FileDescriptor socket_;
};

}  // namespace convexcut::socketcan::test

#define CONVEXCUT_NEEDS_VCAN()                              \
  if (!::convexcut::socketcan::test::why_no_vcan().empty()) \
  GTEST_SKIP() << "needs a virtual CAN interface: " << ::convexcut::socketcan::test::why_no_vcan()
