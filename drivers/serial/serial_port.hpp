// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <termios.h>

#include "drivers/live/file_descriptor.hpp"
#include "drivers/wire.hpp"

namespace convexcut::serial {

// The bit rates of the MTi (SetBaudrate) that termios has; it has none of 14400, 28800 and 76800.
[[nodiscard]] std::span<const std::uint32_t> supported_bauds() noexcept;
[[nodiscard]] bool is_supported(std::uint32_t baud) noexcept;
// The rate that a terminal is set to; 0: none of these.
[[nodiscard]] std::uint32_t baud_of(const termios& settings) noexcept;

// A serial line as a device speaks on it: raw bytes, 8N1, no flow control, ours alone. One thread.
// RT: no allocation.
class SerialPort {
 public:
  // Opens the device, drops what lies in its buffer, and asks its driver for low latency. `baud` 0
  // leaves the rate as it is (USB). Returns 0 or errno: EBUSY when another program has it, ENOTTY
  // when it is no terminal, EINVAL for a rate that it does not take.
  [[nodiscard]] int open(const std::string& device, std::uint32_t baud) noexcept;
  void close() noexcept;

  [[nodiscard]] bool is_open() const noexcept { return static_cast<bool>(fd_); }
  [[nodiscard]] int fd() const noexcept { return fd_.get(); }
  // Whether the driver hands bytes on at once (ASYNC_LOW_LATENCY); USB adapters otherwise collect
  // them for up to 16 ms.
  [[nodiscard]] bool low_latency() const noexcept { return low_latency_; }

  // What lies there, without waiting; `size` says how much. Returns 0 or errno: EAGAIN for nothing,
  // EIO for a line that was hung up.
  [[nodiscard]] int read(wire::WritableBytes buffer, std::size_t& size) noexcept;
  // Without waiting; 0 or errno, EAGAIN also when only a part was taken.
  [[nodiscard]] int write(wire::Bytes bytes) noexcept;
  // At once: what was written and has not left yet is lost. 0 or errno.
  [[nodiscard]] int set_baud(std::uint32_t baud) noexcept;

 private:
  [[nodiscard]] int set_up(std::uint32_t baud) noexcept;
  void ask_for_low_latency() noexcept;

  live::FileDescriptor fd_;
  bool low_latency_ = false;
};

}  // namespace convexcut::serial
