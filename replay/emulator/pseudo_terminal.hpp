// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "drivers/live/file_descriptor.hpp"
#include "drivers/wire.hpp"

namespace convexcut::replay {

// The device's end of a serial line whose other end is a terminal on this host that programs open
// as they open a serial port. Destroying it is unplugging: the terminal is gone, and whoever has it
// open is hung up. One thread.
class PseudoTerminal {
 public:
  // `link`, when it is not empty, becomes a symbolic link to the terminal, as udev makes them; an
  // old link is replaced. Throws std::runtime_error of one line.
  explicit PseudoTerminal(std::filesystem::path link = {});
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  // Of the device's end, for poll().
  [[nodiscard]] int fd() const noexcept { return fd_.get(); }

  // Whether a program has the terminal open.
  [[nodiscard]] bool heard() const;
  // The rate that the program has set.
  [[nodiscard]] std::uint32_t baud() const;

  // Sends without waiting; returns how many bytes the line took: none while nobody has it open.
  std::size_t send(wire::Bytes bytes);
  // What has come, without waiting.
  [[nodiscard]] std::vector<std::byte> receive();

 private:
  std::filesystem::path link_;
  std::filesystem::path path_;
  live::FileDescriptor fd_;
};

}  // namespace convexcut::replay
