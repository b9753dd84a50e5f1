// SPDX-License-Identifier: Apache-2.0
//
// The IMU of a simulated rig as the files that its host would have recorded.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/time.hpp"
#include "replay/simulation/rig/rig_state.hpp"
#include "replay/simulation/stream.hpp"
#include "replay/simulation/wire/imu_simulator.hpp"

namespace convexcut::simulation {

// A pcap of link type USER0: one record a read. Throws capture::CaptureError.
void write_serial_imu(const SerialImuOptions& options, RigStateAt motion, HostTime start,
                      const Period& period, std::uint64_t seed, const std::filesystem::path& pcap);

// A log of candump -L. Throws std::runtime_error of one line.
void write_can_imu(const CanImuOptions& options, RigStateAt motion, HostTime start,
                   const Period& period, std::uint64_t seed, const std::filesystem::path& log);

}  // namespace convexcut::simulation
