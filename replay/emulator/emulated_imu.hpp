// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "drivers/wire.hpp"
#include "replay/emulator/mti_emulator.hpp"
#include "replay/emulator/pseudo_terminal.hpp"

namespace convexcut::replay {

// An MTi on a terminal of this host: answers its host's messages, sends what it is given to send
// while it measures, and may be unplugged. Where the terminal is set to another rate than the
// device, both hear garbage, as on a line. One thread.
class EmulatedImu {
 public:
  // Throws as PseudoTerminal.
  explicit EmulatedImu(std::filesystem::path link = {}, MtiOptions options = {});

  void unplug() noexcept { terminal_.reset(); }
  // Powered by its plug, the device restarts. Throws as PseudoTerminal.
  void plug_in();
  [[nodiscard]] bool plugged_in() const noexcept { return terminal_ != nullptr; }
  // Precondition: plugged_in().
  [[nodiscard]] const PseudoTerminal& terminal() const noexcept { return *terminal_; }
  [[nodiscard]] const MtiEmulator& device() const noexcept { return device_; }

  // Answers what has come.
  void answer();
  // Whether the line took the message, whole: not when the device is unplugged or being configured,
  // nobody listens or does at another rate, or the host has stopped reading.
  bool measure(wire::Bytes message);
  // Bytes that are no message of the device.
  void disturb(wire::Bytes bytes);

 private:
  void send(const std::vector<MtiReply>& replies);
  bool send(wire::Bytes bytes, std::uint32_t baud);

  std::filesystem::path link_;
  MtiEmulator device_;
  std::unique_ptr<PseudoTerminal> terminal_;
  std::vector<std::byte> rest_;  // of the last message: the line had no room for it yet
};

}  // namespace convexcut::replay
