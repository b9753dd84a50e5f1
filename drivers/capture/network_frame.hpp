// SPDX-License-Identifier: Apache-2.0
//
// A captured network frame → the UDP datagram in it.
#pragma once

#include <cstdint>

#include "drivers/capture/record.hpp"
#include "drivers/wire.hpp"

namespace convexcut::capture {

enum class FrameVerdict : std::uint8_t {
  datagram,   // the record's addresses, ports and payload are set
  other,      // no UDP: nothing wrong with it
  fragment,   // part of a fragmented UDP datagram; there is no reassembly
  truncated,  // the capture kept too little of the frame (its snapshot length)
  malformed,  // the frame contradicts itself
};

struct CapturedFrame {
  wire::Bytes bytes;
  bool cut = false;  // the frame on the wire was longer than what was kept
};

// Reads headers of the four network links (ethernet, linux_cooked, linux_cooked2, raw_ip). Every
// length is checked against what was captured; the payload is bounded by the UDP length, so that
// Ethernet's padding is not part of it. Checksums are not verified: captures taken on the sending
// host do not have them yet. The payload refers to the frame's bytes. RT: no allocation.
[[nodiscard]] FrameVerdict parse_frame(LinkKind link, CapturedFrame frame, Record& record) noexcept;

}  // namespace convexcut::capture
