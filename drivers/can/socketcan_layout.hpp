// SPDX-License-Identifier: Apache-2.0
//
// A CAN frame as the Linux kernel hands it to a socket (struct can_frame, struct canfd_frame) and
// as captures of link type LINKTYPE_CAN_SOCKETCAN (227) store it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/time.hpp"
#include "drivers/can/can_frame.hpp"
#include "drivers/wire.hpp"

namespace convexcut::can {

inline constexpr std::size_t kSocketCanIdOffset = 0;
inline constexpr std::size_t kSocketCanLengthOffset = 4;
inline constexpr std::size_t kSocketCanFdFlagsOffset = 5;
inline constexpr std::size_t kSocketCanDataOffset = 8;
inline constexpr std::size_t kClassicRecordSize = kSocketCanDataOffset + kMaxClassicLength;
inline constexpr std::size_t kFdRecordSize = kSocketCanDataOffset + kMaxFdLength;
static_assert(kClassicRecordSize == 16 && kFdRecordSize == 72, "CAN_MTU and CANFD_MTU");

inline constexpr std::uint32_t kExtendedFlag = 0x80000000;
inline constexpr std::uint32_t kRemoteFlag = 0x40000000;
inline constexpr std::uint32_t kErrorFlag = 0x20000000;
inline constexpr std::uint8_t kFdFlag = 0x04;  // CANFD_FDF; older writers leave it out
inline constexpr std::uint8_t kXlFlag = 0x80;  // in the length's place: a CAN XL frame

// The byte order of the id and its flags; all else are single bytes.
enum class IdOrder : std::uint8_t {
  big_endian,  // captures, whatever machine wrote them
  host,        // what a socket gives
};

enum class RecordStatus : std::uint8_t {
  ok,
  truncated,   // shorter than its header and the length in it
  bad_length,  // a length that no frame has
  bad_id,      // more than 11 bits and not marked as extended
  can_xl,      // not supported
};

// `record` is one read or one capture record; bytes past the data are padding. A record is CAN FD
// when it says so, has the size of canfd_frame, or has more than 8 bytes of data. `frame` is set
// only when the status is ok. RT: no allocation, no lock, no system call.
[[nodiscard]] RecordStatus decode_socketcan(wire::Bytes record, IdOrder order, HostTime stamp,
                                            CanFrame& frame) noexcept;

// Sets id, extended, remote and error from an id with the flags above; false for a bad id. RT.
[[nodiscard]] bool split_id(std::uint32_t id_and_flags, CanFrame& frame) noexcept;

}  // namespace convexcut::can
