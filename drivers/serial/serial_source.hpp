// SPDX-License-Identifier: Apache-2.0
//
// An MTi on a serial line, live → ImuDriver.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/counter.hpp"
#include "drivers/live/link_status.hpp"
#include "drivers/live/live_source.hpp"
#include "drivers/live/raw_tap.hpp"
#include "drivers/live/retry_pause.hpp"
#include "drivers/serial/serial_port.hpp"
#include "drivers/xsens/imu_driver.hpp"
#include "drivers/xsens/mt_configuration.hpp"

namespace convexcut::serial {

struct SerialSourceOptions {
  // As it is given; one of /dev/serial/by-id stays the same device wherever it is plugged in.
  std::string device;
  std::uint32_t baud = 115200;  // 0: left as it is (USB)
  // Nothing: what the device sends is taken, and nothing is sent to it.
  std::optional<xsens::MtConfigurationOptions> configuration = std::nullopt;
};

struct SerialCounters {
  Counter reads;
  Counter bytes;
  Counter opened;     // times that the device was opened: 1, and 1 for each time it was plugged in
  Counter unplugged;  // times that it went away while it was open
};

// Hands the bytes of each read, stamped right after it, to the tap and to the driver. The link is
// open while the device is. Where the device is to be configured, that is done whenever it has been
// opened, and while it is done what it sends is decoded all the same. A device that goes away
// (unplugged, hung up) is closed and tried again a few times a second.
//
// Thread: receive() on one; the rest from any. RT: see LiveSource.
class SerialSource final : public live::LiveSource, private xsens::MtLine {
 public:
  // `driver` and `tap` (which may be null) outlive the source.
  SerialSource(SerialSourceOptions options, xsens::ImuDriver& driver, live::RawTap* tap = nullptr);
  ~SerialSource() override;

  void receive(Duration wait) noexcept override;
  [[nodiscard]] live::LinkState link() const noexcept override { return status_.state(); }
  [[nodiscard]] int last_error() const noexcept override { return status_.last_error(); }

  // Null for a device that is not configured.
  [[nodiscard]] const xsens::MtConfiguration* configuration() const noexcept {
    return configuration_ ? &*configuration_ : nullptr;
  }
  [[nodiscard]] const SerialCounters& counters() const noexcept { return counters_; }
  // See SerialPort::low_latency(); false while the device is closed.
  [[nodiscard]] bool low_latency() const noexcept {
    return low_latency_.load(std::memory_order_relaxed);  // a value on its own: orders nothing
  }

 private:
  // More than comes in 20 ms at 2 Mbit/s.
  static constexpr std::size_t kBufferSize = 4096;

  void open() noexcept;
  void lose(int error) noexcept;
  void wait_for_input(Duration wait) noexcept;
  void drain() noexcept;
  void deliver(wire::Bytes bytes, HostTime stamp) noexcept;
  // Of the device's configuration.
  void send(wire::Bytes frame) noexcept override;
  bool set_baud(std::uint32_t baud) noexcept override;

  SerialSourceOptions options_;
  xsens::ImuDriver& driver_;
  live::RawTap* tap_;
  live::LinkStatus status_;
  live::RetryPause pause_;
  SerialCounters counters_;
  std::atomic<bool> low_latency_{false};  // pairs with low_latency()
  SerialPort port_;
  std::optional<xsens::MtConfiguration> configuration_;
  int line_error_ = 0;  // of a write or a change of rate, which happen inside of other calls
  std::array<std::byte, kBufferSize> buffer_;
};

}  // namespace convexcut::serial
