// SPDX-License-Identifier: Apache-2.0
//
// Any text as a candump log; its frames go through the Xsens CAN driver.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "drivers/can/can_imu_driver.hpp"
#include "drivers/can/candump.hpp"
#include "tests/fuzz/xsens/check.hpp"

namespace {

using convexcut::fuzz::CheckingSink;
using convexcut::fuzz::require;
namespace can = convexcut::can;

void check_frame(const can::CandumpLine& line) {
  const can::CanFrame& frame = line.frame;
  require(can::is_valid_length(frame.length, frame.fd), "length is one that frames have");
  require(frame.id <= can::kMaxExtendedId, "29 bits of id");
  require(frame.extended || frame.error || frame.id <= can::kMaxStandardId, "11 bits of id");
  require(!frame.remote || frame.length == 0, "requests have no data");
  require(to_ns(frame.stamp) >= 0, "stamps after 1970");
  require(!line.interface.empty(), "interface is named");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  CheckingSink sink;
  can::CanImuDriver driver({}, sink);
  std::string_view text(reinterpret_cast<const char*>(data), size);
  while (!text.empty()) {
    const std::string_view text_line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text_line.size() + 1, text.size()));
    can::CandumpLine line;
    if (can::parse_candump_line(text_line, line) != can::CandumpStatus::frame) continue;
    check_frame(line);
    driver.on_frame(line.frame);
  }
  driver.flush();
  require(sink.count() <= driver.counters().groups.value(), "no more samples than groups");
  return 0;
}
