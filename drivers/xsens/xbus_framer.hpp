// SPDX-License-Identifier: Apache-2.0
//
// Finds Xbus frames in a byte stream that arrives in arbitrary chunks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "core/counter.hpp"
#include "drivers/wire.hpp"
#include "drivers/xsens/xbus.hpp"

namespace convexcut::xsens {

struct XbusFrame {
  std::uint8_t message_id = 0;
  wire::Bytes payload;           // 0 … 2048 bytes, valid during the call only
  std::size_t size = 0;          // of the whole frame on the line
  std::size_t bytes_behind = 0;  // that had come in after the frame's last byte, bytes
};

struct XbusCounters {
  Counter frames;           // with a good checksum
  Counter checksum_errors;  // also what looks like a frame inside garbage
  Counter length_errors;    // extended length outside 255 … 2048
  Counter skipped_bytes;    // in no frame; every received byte is in a frame, skipped or pending
};

// After a bad checksum or length the search goes on ONE byte later: 0xFA may occur inside data, and
// a false start must not swallow the frame that begins within it. A start is 0xFA 0xFF: a
// stand-alone device has no other bus id, and demanding it keeps false starts from holding up real
// frames. One thread. RT: no allocation, no lock, no system call.
class XbusFramer {
 public:
  // `counters` outlives the framer.
  explicit XbusFramer(XbusCounters& counters) noexcept : counters_(counters) {}

  // on_frame(const XbusFrame&) is called for each frame that `bytes` completes, in order.
  template <class OnFrame>
  void feed(wire::Bytes bytes,
            OnFrame&& on_frame) noexcept(std::is_nothrow_invocable_v<OnFrame&, const XbusFrame&>) {
    while (!bytes.empty()) {
      bytes = bytes.subspan(append(bytes));
      while (std::optional<XbusFrame> frame = next()) {
        frame->bytes_behind = pending() + bytes.size();
        on_frame(*frame);
      }
      compact();
    }
  }

  // Bytes of a frame that is not complete yet.
  [[nodiscard]] std::size_t pending() const noexcept { return end_ - begin_; }

 private:
  // Takes as many bytes as there is room for (at least one), and says how many.
  std::size_t append(wire::Bytes bytes) noexcept;
  // The next complete frame of the buffer, if any; bytes before it are skipped and counted.
  std::optional<XbusFrame> next() noexcept;
  void compact() noexcept;
  void skip_one() noexcept;

  static constexpr std::size_t kBufferSize = kMaxPayload + 8;
  static_assert(kBufferSize > kMaxFrame, "an incomplete frame must leave room for a byte");

  XbusCounters& counters_;
  std::array<std::byte, kBufferSize> buffer_;
  std::size_t begin_ = 0;  // buffer_[begin_, end_) is not looked at yet
  std::size_t end_ = 0;
};

}  // namespace convexcut::xsens
