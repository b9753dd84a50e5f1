// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/angle.hpp"
#include "core/time.hpp"

namespace convexcut {

// One reading of the angle of a stage that turns the lidar.
struct EncoderSample {
  // Earliest instant at which the host can have had it: the frame's stamp less its time on the bus.
  // Encoders on a bus send no time of their own.
  HostTime arrival{};
  Radians angle{};  // not reduced to one turn
};

}  // namespace convexcut
