// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/capture/record.hpp"

namespace convexcut::live {

// Hears every datagram, read and frame as it came, before it is decoded: how a live run is
// recorded. Called on the source's receive thread: RT, no allocation, no lock; what it cannot take
// it counts.
class RawTap {
 public:
  RawTap() = default;
  RawTap(const RawTap&) = delete;
  RawTap& operator=(const RawTap&) = delete;
  virtual ~RawTap() = default;

  // `record` and its payload are valid during the call only. A CAN frame's payload is laid out as
  // in a capture (drivers/can/socketcan_layout.hpp).
  virtual void on_record(const capture::Record& record) noexcept = 0;
};

}  // namespace convexcut::live
