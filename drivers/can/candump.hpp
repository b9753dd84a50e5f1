// SPDX-License-Identifier: Apache-2.0
//
// Log files of candump -l / -L (can-utils): one frame a line,
//
//   (1436509052.249713) can0 044#2A366C2BBA        classic, 3 hex digits: 11-bit id
//   (1700000000.000100) can0 18FF0034#00.11.22 R   8 digits: 29-bit id; dots and direction optional
//   (1700000000.000200) can0 123##1112233          CAN FD: one digit of flags before the data
//   (1700000000.000300) can0 123#R4                remote request
#pragma once

#include <cstdint>
#include <string_view>

#include "drivers/can/can_frame.hpp"

namespace convexcut::can {

enum class CandumpStatus : std::uint8_t {
  frame,
  blank,       // an empty line
  drop_note,   // "DROPCOUNT: …", which candump -d writes
  can_xl,      // a CAN XL frame: not supported
  bad_time,    // not "(seconds.fraction)", or outside the range of int64 nanoseconds
  bad_name,    // no interface name
  bad_id,      // neither 3 nor 8 hex digits before '#', or a number that is no id
  bad_data,    // not whole bytes, or a length that no frame has
  bad_ending,  // something else than a direction behind the frame
};

enum class Direction : std::uint8_t { unknown, received, transmitted };

struct CandumpLine {
  CanFrame frame;
  std::string_view interface;  // points into the line
  Direction direction = Direction::unknown;
};

// One line, with or without its line end. Fractions of 1 to 9 digits. `out` is set only when the
// status is frame. No allocation, no exception.
[[nodiscard]] CandumpStatus parse_candump_line(std::string_view line, CandumpLine& out) noexcept;

}  // namespace convexcut::can
