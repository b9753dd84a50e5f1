// SPDX-License-Identifier: Apache-2.0
#include "replay/emulator/mti_emulator.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "drivers/xsens/baud_code.hpp"
#include "drivers/xsens/xbus_writer.hpp"

namespace convexcut::replay {
namespace {

using xsens::MessageId;

constexpr std::uint8_t kInvalidMessage = 4;
constexpr std::uint8_t kInvalidBaudrate = 32;
constexpr std::uint8_t kInvalidParameter = 33;
constexpr std::uint16_t kEveryMessage = 0xFFFF;
constexpr std::size_t kOutputSize = 4;
constexpr std::size_t kMaxOutputs = 32;
constexpr std::size_t kProductCodeSize = 20;

std::vector<std::byte> device_id(std::uint32_t id) {
  std::vector<std::byte> payload(sizeof(id));
  wire::store_be<std::uint32_t>(payload, 0, id);
  return payload;
}

std::vector<std::byte> product_code(const std::string& code) {
  std::vector<std::byte> payload(kProductCodeSize, std::byte{' '});
  for (std::size_t i = 0; i < std::min(code.size(), payload.size()); ++i) {
    payload[i] = static_cast<std::byte>(code[i]);
  }
  return payload;
}

// 1.8.2, build 37, revision 70964.
constexpr std::array<std::byte, 11> kFirmware{
    std::byte{1},  std::byte{8}, std::byte{2}, std::byte{0},    std::byte{0},   std::byte{0},
    std::byte{37}, std::byte{0}, std::byte{1}, std::byte{0x15}, std::byte{0x34}};

std::vector<std::byte> list_of(const std::vector<MtiOutput>& outputs) {
  std::vector<std::byte> payload(outputs.size() * kOutputSize);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    wire::store_be<std::uint16_t>(payload, i * kOutputSize, outputs[i].data_id);
    wire::store_be<std::uint16_t>(payload, i * kOutputSize + 2, outputs[i].rate_hz);
  }
  return payload;
}

}  // namespace

MtiEmulator::MtiEmulator(MtiOptions options)
    : options_(std::move(options)),
      measuring_(options_.measuring),
      baud_(options_.baud),
      next_baud_(options_.baud),
      outputs_{{static_cast<std::uint16_t>(xsens::DataType::packet_counter), kEveryMessage},
               {static_cast<std::uint16_t>(xsens::DataType::quaternion), 100}},
      deaf_to_(options_.deaf_to) {}

std::vector<MtiReply> MtiEmulator::on_bytes(wire::Bytes bytes) {
  framer_.feed(bytes, [&](const xsens::XbusFrame& frame) { on_message(frame); });
  return std::exchange(replies_, {});
}

std::vector<MtiReply> MtiEmulator::power_on() {
  restart();
  return std::exchange(replies_, {});
}

void MtiEmulator::reply(MessageId message, wire::Bytes payload) {
  replies_.push_back({baud_, xsens::make_frame(message, payload)});
}

void MtiEmulator::reply_error(std::uint8_t code) {
  reply(MessageId::error, std::array{std::byte{code}});
}

void MtiEmulator::on_message(const xsens::XbusFrame& frame) {
  if (deaf_to_ > 0) {
    --deaf_to_;
    return;
  }
  switch (static_cast<MessageId>(frame.message_id)) {
    case MessageId::go_to_config:
      measuring_ = false;
      return reply(MessageId::go_to_config_ack);
    case MessageId::reset:
      reply(MessageId::reset_ack);
      return restart();
    default:
      // All else is for the configuration state; a measuring device does not listen.
      if (!measuring_) configure(frame);
  }
}

void MtiEmulator::configure(const xsens::XbusFrame& frame) {
  switch (static_cast<MessageId>(frame.message_id)) {
    case MessageId::go_to_measurement:
      measuring_ = true;
      return reply(MessageId::go_to_measurement_ack);
    case MessageId::req_device_id:
      return reply(MessageId::device_id, device_id(options_.device_id));
    case MessageId::req_product_code:
      return reply(MessageId::product_code, product_code(options_.product_code));
    case MessageId::req_firmware_revision:
      return reply(MessageId::firmware_revision, kFirmware);
    case MessageId::baudrate:
      return on_baudrate(frame.payload);
    case MessageId::set_output_configuration:
      return on_outputs(frame.payload);
    default:
      return reply_error(kInvalidMessage);
  }
}

void MtiEmulator::on_baudrate(wire::Bytes payload) {
  if (payload.empty()) {
    const auto code = static_cast<std::byte>(*xsens::code_of_baud(baud_));
    return reply(MessageId::baudrate_ack, std::array{code});
  }
  const auto baud = xsens::baud_of_code(wire::load_u8(payload, 0));
  if (!baud) return reply_error(kInvalidBaudrate);
  next_baud_ = *baud;
  reply(MessageId::baudrate_ack);
  if (options_.baud_at_once) baud_ = next_baud_;
}

void MtiEmulator::on_outputs(wire::Bytes payload) {
  if (options_.refuse_with != 0) return reply_error(options_.refuse_with);
  if (payload.size() % kOutputSize != 0 || payload.size() > kMaxOutputs * kOutputSize) {
    return reply_error(kInvalidParameter);
  }
  if (!payload.empty()) outputs_.clear();
  for (; !payload.empty(); payload = payload.subspan(kOutputSize)) {
    MtiOutput output{wire::load_be<std::uint16_t>(payload, 0),
                     wire::load_be<std::uint16_t>(payload, 2)};
    if (options_.deny_rates && output.rate_hz != kEveryMessage) output.rate_hz /= 2;
    outputs_.push_back(output);
  }
  reply(MessageId::output_configuration, list_of(outputs_));
}

void MtiEmulator::restart() {
  baud_ = next_baud_;
  measuring_ = true;  // a host that wants to configure says so
  reply(MessageId::wake_up);
}

}  // namespace convexcut::replay
