// SPDX-License-Identifier: Apache-2.0
//
// What an MTi-30 answers to its host, without the sensors in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/wire.hpp"
#include "drivers/xsens/mt_data_id.hpp"
#include "drivers/xsens/xbus_framer.hpp"

namespace convexcut::replay {

struct MtiOutput {
  std::uint16_t data_id = 0;
  std::uint16_t rate_hz = 0;  // 0xFFFF: with every message
  friend bool operator==(const MtiOutput&, const MtiOutput&) = default;
};

struct MtiOptions {
  std::uint32_t baud = 115200;
  bool measuring = true;  // false: as after a host that died while it configured
  // When a new rate is taken: the documents leave it open. At once: after the acknowledgement.
  bool baud_at_once = false;
  std::uint32_t device_id = 0x03'80'00'30;
  std::string product_code = "MTi-30-2A5G4";

  // Faults.
  std::size_t deaf_to = 0;       // the first so many messages are not answered
  std::uint8_t refuse_with = 0;  // SetOutputConfiguration is answered with this error code; 0: not
  bool deny_rates = false;       // it is acknowledged at half the rates
};

// One message of the device, and the rate it goes out at.
struct MtiReply {
  std::uint32_t baud = 0;
  std::vector<std::byte> bytes;
};

// The protocol half of an emulated device: bytes of the host in, bytes of the device out. Which
// line they go over, and what the device measures, is the user's. One thread.
class MtiEmulator {
 public:
  explicit MtiEmulator(MtiOptions options = {});

  // What the host has sent, at the device's rate; returns the answers.
  [[nodiscard]] std::vector<MtiReply> on_bytes(wire::Bytes bytes);
  // The power was off and is on again: the device restarts and says so.
  [[nodiscard]] std::vector<MtiReply> power_on();

  // Whether it sends measurements now.
  [[nodiscard]] bool measuring() const noexcept { return measuring_; }
  // That it sends and listens at.
  [[nodiscard]] std::uint32_t baud() const noexcept { return baud_; }
  // As the host has set them, else the factory's.
  [[nodiscard]] const std::vector<MtiOutput>& outputs() const noexcept { return outputs_; }
  // Whole messages of the host, answered or not.
  [[nodiscard]] std::uint64_t messages() const noexcept { return counters_.frames.value(); }

 private:
  void on_message(const xsens::XbusFrame& frame);
  void configure(const xsens::XbusFrame& frame);
  void on_baudrate(wire::Bytes payload);
  void on_outputs(wire::Bytes payload);
  void restart();
  void reply(xsens::MessageId message, wire::Bytes payload = {});
  void reply_error(std::uint8_t code);

  MtiOptions options_;
  bool measuring_;
  std::uint32_t baud_;
  std::uint32_t next_baud_;
  std::vector<MtiOutput> outputs_;
  std::size_t deaf_to_;
  std::vector<MtiReply> replies_;
  xsens::XbusCounters counters_;
  xsens::XbusFramer framer_{counters_};
};

}  // namespace convexcut::replay
