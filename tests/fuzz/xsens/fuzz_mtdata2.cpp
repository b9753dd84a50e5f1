// SPDX-License-Identifier: Apache-2.0
//
// Mutated MTData2 messages whose length and checksum are right, so that the payload parser gets all
// of them: without the mutator below, the checksum would stop nearly everything.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/xsens/imu_driver.hpp"
#include "tests/fuzz/xsens/check.hpp"

// NOLINTBEGIN(readability-identifier-naming): libFuzzer's names
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using convexcut::HostTime;
using convexcut::fuzz::CheckingSink;
using convexcut::fuzz::require;
namespace wire = convexcut::wire;
namespace xsens = convexcut::xsens;

std::vector<std::uint8_t> frame_of(const std::vector<std::uint8_t>& payload) {
  std::vector<std::uint8_t> frame = {xsens::kPreamble, xsens::kBusId,
                                     static_cast<std::uint8_t>(xsens::MessageId::mtdata2)};
  if (payload.size() < xsens::kMinExtendedLength) {
    frame.push_back(static_cast<std::uint8_t>(payload.size()));
  } else {
    frame.push_back(xsens::kExtendedLength);
    frame.push_back(static_cast<std::uint8_t>(payload.size() >> 8U));
    frame.push_back(static_cast<std::uint8_t>(payload.size()));
  }
  frame.insert(frame.end(), payload.begin(), payload.end());
  std::uint8_t sum = 0;
  for (std::size_t i = xsens::kBusIdOffset; i < frame.size(); ++i) {
    sum = static_cast<std::uint8_t>(sum + frame[i]);
  }
  frame.push_back(static_cast<std::uint8_t>(-sum));
  return frame;
}

std::size_t header_size(const std::uint8_t* frame, std::size_t size) {
  const bool extended =
      size > xsens::kLengthOffset && frame[xsens::kLengthOffset] == xsens::kExtendedLength;
  return extended ? xsens::kExtendedHeaderSize : xsens::kHeaderSize;
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int /*seed*/) {
  if (max_size <= xsens::kExtendedHeaderSize + xsens::kChecksumSize) return size;
  const std::size_t header = header_size(data, size);
  const std::size_t around = header + xsens::kChecksumSize;
  std::vector<std::uint8_t> payload;
  if (size > around) payload.assign(data + header, data + size - xsens::kChecksumSize);
  const std::size_t room =
      std::min(max_size - xsens::kExtendedHeaderSize - xsens::kChecksumSize, xsens::kMaxPayload);
  payload.resize(std::min(payload.size(), room));
  const std::size_t length = payload.size();
  payload.resize(room);
  payload.resize(LLVMFuzzerMutate(payload.data(), length, room));
  const std::vector<std::uint8_t> frame = frame_of(payload);
  std::copy(frame.begin(), frame.end(), data);
  return frame.size();
}
// NOLINTEND(readability-identifier-naming)

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const wire::Bytes bytes = std::as_bytes(std::span(data, size));
  CheckingSink sink;
  xsens::ImuDriver driver({}, sink);
  driver.on_bytes(bytes, HostTime{});

  xsens::XbusCounters counters;
  xsens::XbusFramer framer(counters);
  framer.feed(bytes, [](const xsens::XbusFrame& frame) noexcept {
    xsens::MtMeasurement m;
    const bool ok = xsens::parse_mtdata2(frame.payload, m) == xsens::PayloadStatus::ok;
    require(ok || m.items == 0, "a rejected payload leaves nothing behind");
  });
  return 0;
}
