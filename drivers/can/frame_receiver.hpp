// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/can/can_frame.hpp"

namespace convexcut::can {

// Takes the frames of a bus in the order in which the host received them. One thread. RT: no
// allocation, no lock, no system call.
class FrameReceiver {
 public:
  FrameReceiver() = default;
  FrameReceiver(const FrameReceiver&) = delete;
  FrameReceiver& operator=(const FrameReceiver&) = delete;
  virtual ~FrameReceiver() = default;

  virtual void on_frame(const CanFrame& frame) noexcept = 0;
  // No frame follows, or none has come for a while: what waits for its rest is handed on.
  virtual void flush() noexcept = 0;
};

}  // namespace convexcut::can
