// SPDX-License-Identifier: Apache-2.0
//
// Any bytes in any chunking through the serial driver. The first two bytes seed the chunk sizes.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "drivers/xsens/imu_driver.hpp"
#include "drivers/xsens/mt_statistics.hpp"
#include "tests/fuzz/xsens/check.hpp"

namespace {

using convexcut::HostTime;
using convexcut::fuzz::CheckingSink;
using convexcut::fuzz::require;
namespace wire = convexcut::wire;
namespace xsens = convexcut::xsens;

constexpr std::size_t kSeedSize = 2;

// Chunks of 1 … 64 bytes, from a linear congruential generator.
class ChunkSizes {
 public:
  explicit ChunkSizes(std::uint32_t seed) : state_(seed) {}
  std::size_t next() {
    state_ = state_ * 1664525U + 1013904223U;
    return 1 + (state_ >> 26U);
  }

 private:
  std::uint32_t state_;
};

void check_accounting(wire::Bytes bytes) {
  xsens::XbusCounters counters;
  xsens::XbusFramer framer(counters);
  std::size_t framed = 0;
  std::size_t left = bytes.size();
  framer.feed(bytes, [&](const xsens::XbusFrame& frame) noexcept {
    framed += frame.size;
    require(frame.payload.size() <= xsens::kMaxPayload, "payload within its limit");
    require(frame.bytes_behind < left, "frames come in order");
    left = frame.bytes_behind;
  });
  require(framed + counters.skipped_bytes.value() + framer.pending() == bytes.size(),
          "every byte is in a frame, skipped or pending");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < kSeedSize) return 0;
  const wire::Bytes input = std::as_bytes(std::span(data, size));
  const wire::Bytes bytes = input.subspan(kSeedSize);
  check_accounting(bytes);

  CheckingSink whole;
  xsens::ImuDriver whole_driver({.baud = 115200, .unstamped_start = HostTime{}}, whole);
  whole_driver.on_bytes(bytes, HostTime{});

  CheckingSink chunked;
  xsens::ImuDriver chunked_driver({.baud = 115200, .unstamped_start = HostTime{}}, chunked);
  ChunkSizes sizes(wire::load_be<std::uint16_t>(input, 0));
  for (wire::Bytes rest = bytes; !rest.empty();) {
    const std::size_t chunk = std::min(rest.size(), sizes.next());
    chunked_driver.on_bytes(rest.first(chunk), HostTime{});
    rest = rest.subspan(chunk);
  }
  require(whole.count() == chunked.count() && whole.digest() == chunked.digest(),
          "the same samples in any chunking");

  xsens::MtStatistics statistics;
  statistics.on_bytes(bytes);
  return 0;
}
