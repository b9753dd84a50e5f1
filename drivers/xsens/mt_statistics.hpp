// SPDX-License-Identifier: Apache-2.0
//
// What a recorded serial stream holds, for people (`convexcut info`). Allocates: not for the
// receive thread.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "drivers/xsens/sample_clock.hpp"
#include "drivers/xsens/xbus_framer.hpp"

namespace convexcut::xsens {

class MtStatistics {
 public:
  struct DataItem {
    std::uint64_t count = 0;
    std::uint8_t smallest = 255;  // bytes of data
    std::uint8_t largest = 0;
    std::uint64_t timed = 0;  // of `count`, those in messages with device time
    ImuTime earliest{};       // of the timed ones
    ImuTime latest{};
    // From the device's time; empty with fewer than two instants.
    [[nodiscard]] std::optional<double> rate_hz() const;
  };

  void on_bytes(wire::Bytes bytes);

  // By data identifier, and by message id.
  [[nodiscard]] const std::map<std::uint16_t, DataItem>& items() const { return items_; }
  [[nodiscard]] const std::map<std::uint8_t, std::uint64_t>& messages() const { return messages_; }
  // In hexadecimal, as DeviceID messages (0x01) state them, each once, in order of appearance.
  [[nodiscard]] const std::vector<std::string>& device_ids() const { return device_ids_; }
  // As ProductCode messages (0x1D) state them, without their padding.
  [[nodiscard]] const std::vector<std::string>& product_codes() const { return product_codes_; }
  [[nodiscard]] const XbusCounters& xbus() const { return counters_; }
  [[nodiscard]] std::uint64_t malformed_payloads() const { return malformed_payloads_; }

 private:
  void on_frame(const XbusFrame& frame);
  void on_data(wire::Bytes payload);

  XbusCounters counters_;
  XbusFramer framer_{counters_};
  SampleClock clock_ = SampleClock::sample_time_fine();
  std::map<std::uint16_t, DataItem> items_;
  std::map<std::uint8_t, std::uint64_t> messages_;
  std::vector<std::string> device_ids_;
  std::vector<std::string> product_codes_;
  std::uint64_t malformed_payloads_ = 0;
};

}  // namespace convexcut::xsens
