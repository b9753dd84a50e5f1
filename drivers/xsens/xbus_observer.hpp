// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/xsens/xbus_framer.hpp"

namespace convexcut::xsens {

// Hears every good frame of a line before it is decoded, on the receive thread: RT.
class XbusObserver {
 public:
  XbusObserver() = default;
  XbusObserver(const XbusObserver&) = delete;
  XbusObserver& operator=(const XbusObserver&) = delete;
  virtual ~XbusObserver() = default;

  virtual void on_frame(const XbusFrame& frame) noexcept = 0;
};

}  // namespace convexcut::xsens
