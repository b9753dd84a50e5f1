// SPDX-License-Identifier: Apache-2.0
//
// The position packet: state of the sensor's clock, the GPS sentence, and the three gyroscopes and
// accelerometers in the HDL-32E's base. Those are housekeeping: their axes are undocumented and
// their bias is tens of degrees a second. The board temperatures of newer firmware are left out.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/return_batch.hpp"
#include "core/time.hpp"
#include "drivers/velodyne/nmea.hpp"
#include "drivers/velodyne/wire_layout.hpp"
#include "drivers/wire.hpp"

namespace convexcut::velodyne {

struct MotionSensor {
  float rate_deg_s = 0.0F;
  float temperature_c = 0.0F;
  float acceleration_x_g = 0.0F;
  float acceleration_y_g = 0.0F;
};

struct PositionPacket {
  MicrosPastHour time{};  // when it was sent, by the sensor's clock
  PpsState pps = PpsState::unknown;
  NmeaStatus nmea_status = NmeaStatus::absent;
  NmeaFix fix;  // meaningful with NmeaStatus::ok
  // Nothing from sensors that have none: a VLP-16 leaves the words zero.
  std::array<std::optional<MotionSensor>, wire_layout::kMotionSets> motion;
};

enum class PositionStatus : std::uint8_t {
  ok,
  wrong_length,            // not 512 bytes
  no_sentence,             // neither '$' nor 0 where the sentence starts: not Velodyne
  timestamp_out_of_range,  // more than a second past the hour's end
};

// Leaves `out` untouched unless the status is ok. A broken sentence in a good packet is
// nmea_status. Thread: any. RT: no allocation, no lock.
[[nodiscard]] PositionStatus decode_position_packet(wire::Bytes payload,
                                                    PositionPacket& out) noexcept;

}  // namespace convexcut::velodyne
