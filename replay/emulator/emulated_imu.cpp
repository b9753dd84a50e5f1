// SPDX-License-Identifier: Apache-2.0
#include "replay/emulator/emulated_imu.hpp"

#include <utility>
#include <vector>

namespace convexcut::replay {
namespace {

// What a receiver at the wrong rate makes of bytes: something else, and not as many.
std::vector<std::byte> garbled(wire::Bytes bytes) {
  constexpr std::byte kNoise{0x5A};
  std::vector<std::byte> heard;
  for (std::size_t i = 0; i < bytes.size(); i += 2) heard.push_back(bytes[i] ^ kNoise);
  return heard;
}

}  // namespace

EmulatedImu::EmulatedImu(std::filesystem::path link, MtiOptions options)
    : link_(std::move(link)),
      device_(std::move(options)),
      terminal_(std::make_unique<PseudoTerminal>(link_)) {}

void EmulatedImu::plug_in() {
  terminal_ = std::make_unique<PseudoTerminal>(link_);
  rest_.clear();
  send(device_.power_on());
}

void EmulatedImu::answer() {
  if (!plugged_in()) return;
  const std::vector<std::byte> bytes = terminal_->receive();
  if (bytes.empty()) return;
  const bool understood = terminal_->baud() == device_.baud();
  send(device_.on_bytes(understood ? bytes : garbled(bytes)));
}

bool EmulatedImu::measure(wire::Bytes message) {
  if (!plugged_in() || !device_.measuring()) return false;
  return send(message, device_.baud());
}

void EmulatedImu::disturb(wire::Bytes bytes) {
  if (plugged_in()) terminal_->send(bytes);
}

void EmulatedImu::send(const std::vector<MtiReply>& replies) {
  for (const MtiReply& reply : replies) send(reply.bytes, reply.baud);
}

bool EmulatedImu::send(wire::Bytes bytes, std::uint32_t baud) {
  if (!terminal_->heard()) {
    rest_.clear();
    return false;
  }
  if (terminal_->baud() != baud) {
    terminal_->send(garbled(bytes));
    return false;
  }
  if (!rest_.empty()) {
    const std::size_t sent = terminal_->send(rest_);
    rest_.erase(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(sent));
    if (!rest_.empty()) return false;
  }
  const std::size_t sent = terminal_->send(bytes);
  if (sent == 0) return false;
  const wire::Bytes rest = bytes.subspan(sent);
  rest_.assign(rest.begin(), rest.end());
  return true;
}

}  // namespace convexcut::replay
