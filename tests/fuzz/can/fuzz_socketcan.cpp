// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as one SocketCAN record, of a capture and of a socket.
#include <cstddef>
#include <cstdint>

#include "drivers/can/socketcan_layout.hpp"
#include "tests/fuzz/xsens/check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace can = convexcut::can;
  using convexcut::fuzz::require;
  const convexcut::wire::Bytes record = std::as_bytes(std::span(data, size));
  for (const can::IdOrder order : {can::IdOrder::big_endian, can::IdOrder::host}) {
    can::CanFrame frame;
    if (can::decode_socketcan(record, order, {}, frame) != can::RecordStatus::ok) continue;
    require(can::is_valid_length(frame.length, frame.fd), "length is one that frames have");
    require(frame.extended || frame.error || frame.id <= can::kMaxStandardId, "11 bits of id");
    require(frame.length + can::kSocketCanDataOffset <= size, "data within the record");
  }
  return 0;
}
