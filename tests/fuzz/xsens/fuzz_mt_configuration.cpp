// SPDX-License-Identifier: Apache-2.0
//
// A device that answers the configuration dialogue with anything at any time. An input is a row of
// events: how long nothing happens, then a message with any id and payload. Frames are whole: their
// checksum is the framer's matter (fuzz_xbus). Does not prove what the device is left at.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "drivers/xsens/mt_configuration.hpp"
#include "tests/fuzz/xsens/check.hpp"

namespace {

using convexcut::fuzz::require;
using convexcut::xsens::MtConfiguration;
using convexcut::xsens::MtState;
using convexcut::xsens::XbusFrame;
namespace wire = convexcut::wire;
namespace xsens = convexcut::xsens;

// Of an event: pauses of 4 ms up to 1.02 s, the message's id, how many bytes follow as its payload.
constexpr std::size_t kPause = 0;
constexpr std::size_t kMessage = 1;
constexpr std::size_t kLength = 2;
constexpr std::size_t kEventHeader = 3;
constexpr auto kPauseUnit = std::chrono::milliseconds{4};
// A request may follow an answer at once; without answers the next one waits for its time.
constexpr int kRequestsAnEvent = 4;

class CheckingLine final : public xsens::MtLine {
 public:
  void send(wire::Bytes frame) noexcept override {
    require(frame.size() >= xsens::kHeaderSize + xsens::kChecksumSize, "a request is whole");
    require(frame.back() == xsens::checksum(frame), "its checksum is right");
    ++sent;
  }
  bool set_baud(std::uint32_t baud) noexcept override {
    require(baud > 0, "a rate is a rate");
    return baud <= fastest;
  }
  std::uint32_t fastest = 0;
  int sent = 0;
};

bool is_one_line(const std::string& text) {
  return text.size() < 128 && std::ranges::none_of(text, [](char c) { return c < ' ' || c > '~'; });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const bool is_usb = (data[0] & 1U) != 0;
  CheckingLine line;
  line.fastest = (data[0] & 2U) != 0 ? 115'200 : 4'000'000;
  MtConfiguration configuration({.baud = is_usb ? 0U : 115'200U,
                                 .set_baud = (data[0] & 4U) != 0 ? 460'800U : 0U,
                                 .scan_baud = (data[0] & 8U) != 0},
                                line);
  MtConfiguration::Time now{std::chrono::hours{1}};
  configuration.begin(now);
  wire::Bytes events = std::as_bytes(std::span(data + 1, size - 1));
  while (events.size() >= kEventHeader) {
    line.sent = 0;
    now += wire::load_u8(events, kPause) * kPauseUnit;
    configuration.update(now);
    require(configuration.next_due() > now, "what is due has been done");
    const std::size_t length =
        std::min<std::size_t>(wire::load_u8(events, kLength), events.size() - kEventHeader);
    configuration.on_frame({wire::load_u8(events, kMessage), events.subspan(kEventHeader, length),
                            xsens::kHeaderSize + length, 0});
    require(line.sent <= kRequestsAnEvent, "no answer makes it talk for ever");
    require(configuration.state() != MtState::off, "the line is open");
    require(is_one_line(configuration.identity()), "the identity can be shown");
    events = events.subspan(kEventHeader + length);
  }
  configuration.end();
  require(configuration.state() == MtState::off, "the line is closed");
  return 0;
}
