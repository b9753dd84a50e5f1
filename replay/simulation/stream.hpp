// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace convexcut::simulation {

// Each part of a simulation draws its random numbers from a stream of its own.
enum Stream : std::uint32_t {
  kLidarStream,
  kNetworkStream,
  kSerialImuStream,
  kReadsStream,
  kCanStream,
  kSwayStream,
  kImuErrorStream
};

}  // namespace convexcut::simulation
