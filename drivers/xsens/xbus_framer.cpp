// SPDX-License-Identifier: Apache-2.0
#include "drivers/xsens/xbus_framer.hpp"

#include <algorithm>
#include <cstring>

namespace convexcut::xsens {
namespace {

enum class Verdict : std::uint8_t { frame, incomplete, no_start, bad_length, bad_checksum };

struct Candidate {
  Verdict verdict = Verdict::incomplete;
  std::size_t header = 0;
  std::size_t payload = 0;
  [[nodiscard]] std::size_t size() const noexcept { return header + payload + kChecksumSize; }
};

bool checksum_good(wire::Bytes frame) noexcept {
  std::uint8_t sum = 0;
  for (const std::byte b : frame.subspan(kBusIdOffset)) {
    sum = static_cast<std::uint8_t>(sum + static_cast<std::uint8_t>(b));
  }
  return sum == 0;
}

// What the bytes from here on are, looking at no more of them than there are.
Candidate examine(wire::Bytes bytes) noexcept {
  if (wire::load_u8(bytes, kPreambleOffset) != kPreamble) return {Verdict::no_start};
  if (bytes.size() <= kBusIdOffset) return {};
  if (wire::load_u8(bytes, kBusIdOffset) != kBusId) return {Verdict::no_start};
  if (bytes.size() < kHeaderSize) return {};
  Candidate found{Verdict::incomplete, kHeaderSize, wire::load_u8(bytes, kLengthOffset)};
  if (found.payload == kExtendedLength) {
    if (bytes.size() < kExtendedHeaderSize) return {};
    found.header = kExtendedHeaderSize;
    found.payload = wire::load_be<std::uint16_t>(bytes, kExtendedLengthOffset);
    if (found.payload < kMinExtendedLength || found.payload > kMaxPayload) {
      return {Verdict::bad_length};
    }
  }
  if (bytes.size() < found.size()) return {};
  found.verdict = checksum_good(bytes.first(found.size())) ? Verdict::frame : Verdict::bad_checksum;
  return found;
}

}  // namespace

std::size_t XbusFramer::append(wire::Bytes bytes) noexcept {
  const std::size_t count = std::min(bytes.size(), buffer_.size() - end_);
  std::memcpy(buffer_.data() + end_, bytes.data(), count);
  end_ += count;
  return count;
}

void XbusFramer::skip_one() noexcept {
  ++begin_;
  counters_.skipped_bytes.add();
}

std::optional<XbusFrame> XbusFramer::next() noexcept {
  while (begin_ < end_) {
    const wire::Bytes rest = wire::Bytes(buffer_).subspan(begin_, end_ - begin_);
    const Candidate found = examine(rest);
    switch (found.verdict) {
      case Verdict::incomplete:
        return std::nullopt;
      case Verdict::no_start:
        break;
      case Verdict::bad_length:
        counters_.length_errors.add();
        break;
      case Verdict::bad_checksum:
        counters_.checksum_errors.add();
        break;
      case Verdict::frame:
        counters_.frames.add();
        begin_ += found.size();
        return XbusFrame{wire::load_u8(rest, kMessageIdOffset),
                         rest.subspan(found.header, found.payload), found.size(), 0};
    }
    skip_one();
  }
  return std::nullopt;
}

void XbusFramer::compact() noexcept {
  std::memmove(buffer_.data(), buffer_.data() + begin_, pending());
  end_ = pending();
  begin_ = 0;
}

}  // namespace convexcut::xsens
