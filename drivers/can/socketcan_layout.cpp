// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/socketcan_layout.hpp"

#include <bit>
#include <cstring>

namespace convexcut::can {
namespace {

std::uint32_t load_id(wire::Bytes record, IdOrder order) noexcept {
  if (order == IdOrder::host && std::endian::native == std::endian::little) {
    return wire::load_le<std::uint32_t>(record, kSocketCanIdOffset);
  }
  return wire::load_be<std::uint32_t>(record, kSocketCanIdOffset);
}

}  // namespace

bool split_id(std::uint32_t id_and_flags, CanFrame& frame) noexcept {
  frame.error = (id_and_flags & kErrorFlag) != 0;
  frame.extended = (id_and_flags & kExtendedFlag) != 0 && !frame.error;
  frame.remote = (id_and_flags & kRemoteFlag) != 0 && !frame.error;
  frame.id = id_and_flags & kMaxExtendedId;
  return frame.extended || frame.error || frame.id <= kMaxStandardId;
}

RecordStatus decode_socketcan(wire::Bytes record, IdOrder order, HostTime stamp,
                              CanFrame& frame) noexcept {
  if (record.size() < kSocketCanDataOffset) return RecordStatus::truncated;
  const std::uint8_t length = wire::load_u8(record, kSocketCanLengthOffset);
  if ((length & kXlFlag) != 0) return RecordStatus::can_xl;

  CanFrame decoded;
  decoded.stamp = stamp;
  if (!split_id(load_id(record, order), decoded)) return RecordStatus::bad_id;
  decoded.fd = (wire::load_u8(record, kSocketCanFdFlagsOffset) & kFdFlag) != 0 ||
               record.size() == kFdRecordSize || length > kMaxClassicLength;
  if (decoded.fd && record.size() == kClassicRecordSize && length > kMaxClassicLength) {
    return RecordStatus::bad_length;  // a classic frame's size cannot hold it
  }
  if (!is_valid_length(length, decoded.fd)) return RecordStatus::bad_length;
  // The length of a remote frame asks for data; it has none.
  decoded.length = decoded.remote ? 0 : length;
  if (record.size() - kSocketCanDataOffset < decoded.length) return RecordStatus::truncated;
  std::memcpy(decoded.data.data(), record.data() + kSocketCanDataOffset, decoded.length);
  frame = decoded;
  return RecordStatus::ok;
}

}  // namespace convexcut::can
