// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/time.hpp"
#include "drivers/capture/capture_reader.hpp"
#include "drivers/capture/serial_log.hpp"
#include "drivers/xsens/sample_clock.hpp"
#include "drivers/xsens/xbus_framer.hpp"

namespace convexcut::replay {

struct ImuMessage {
  HostTime stamp{};              // of the read that its last byte came with
  std::vector<std::byte> frame;  // whole
};

// The measurement, error and warning messages of a recorded serial line. Those of a raw .bin stream
// are stamped by the device's own time.
class ImuMessages {
 public:
  // `unstamped_start`: of the first message of a raw stream. Throws capture::CaptureError.
  ImuMessages(const std::filesystem::path& file, HostTime unstamped_start);

  // The next one, valid until pop(); null at the end.
  [[nodiscard]] const ImuMessage* front();
  void pop() { queue_.pop_front(); }

 private:
  [[nodiscard]] bool read();
  void on_frame(const xsens::XbusFrame& frame, HostTime stamp);
  [[nodiscard]] HostTime unstamped(const xsens::XbusFrame& frame);

  std::unique_ptr<capture::CaptureReader> capture_;  // one of the two
  std::unique_ptr<capture::SerialLog> raw_;
  HostTime unstamped_start_;
  xsens::XbusCounters counters_;
  xsens::XbusFramer framer_{counters_};
  xsens::SampleClock clock_ = xsens::SampleClock::sample_time_fine();
  std::optional<ImuTime> first_time_;
  HostTime latest_{};
  std::deque<ImuMessage> queue_;
};

}  // namespace convexcut::replay
