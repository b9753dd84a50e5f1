// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/candump.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "drivers/can/socketcan_layout.hpp"

namespace convexcut::can {
namespace {

constexpr std::size_t kStandardIdDigits = 3;
constexpr std::size_t kExtendedIdDigits = 8;
constexpr std::size_t kMaxInterfaceName = 21;  // what can-utils' own readers take
constexpr std::size_t kMaxSecondDigits = 10;
constexpr std::size_t kMaxFractionDigits = 9;
constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::int64_t kMaxSeconds = 9'223'372'035;  // whole seconds that int64 ns hold, with room
constexpr std::string_view kBlanks = " \t";

std::optional<std::uint8_t> hex_digit(char c) noexcept {
  if (c >= '0' && c <= '9') return static_cast<std::uint8_t>(c - '0');
  if (c >= 'A' && c <= 'F') return static_cast<std::uint8_t>(c - 'A' + 10);
  if (c >= 'a' && c <= 'f') return static_cast<std::uint8_t>(c - 'a' + 10);
  return std::nullopt;
}

// Takes what is in front of the first blank, and the blanks behind it.
std::string_view take_word(std::string_view& text) noexcept {
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text.remove_prefix(word.size());
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return word;
}

std::optional<std::int64_t> decimal(std::string_view digits, std::size_t max_digits) noexcept {
  if (digits.empty() || digits.size() > max_digits) return std::nullopt;
  std::int64_t value = 0;
  for (const char c : digits) {
    if (c < '0' || c > '9') return std::nullopt;
    value = value * 10 + (c - '0');
  }
  return value;
}

// "(seconds.fraction)"
std::optional<HostTime> parse_time(std::string_view word) noexcept {
  if (word.size() < 2 || word.front() != '(' || word.back() != ')') return std::nullopt;
  word = word.substr(1, word.size() - 2);
  const std::size_t dot = word.find('.');
  if (dot == std::string_view::npos) return std::nullopt;
  const auto seconds = decimal(word.substr(0, dot), kMaxSecondDigits);
  auto fraction = decimal(word.substr(dot + 1), kMaxFractionDigits);
  if (!seconds || *seconds > kMaxSeconds || !fraction) return std::nullopt;
  for (std::size_t i = word.size() - dot - 1; i < kMaxFractionDigits; ++i) *fraction *= 10;
  return from_ns<HostTime>(*seconds * kNsPerSecond + *fraction);
}

// 3 digits: standard; 8 digits: extended, or an error frame by its flag.
bool parse_id(std::string_view digits, CanFrame& frame) noexcept {
  if (digits.size() != kStandardIdDigits && digits.size() != kExtendedIdDigits) return false;
  std::uint32_t value = 0;
  for (const char c : digits) {
    const auto digit = hex_digit(c);
    if (!digit) return false;
    value = value << 4U | *digit;
  }
  if (digits.size() == kStandardIdDigits) return split_id(value, frame);
  if ((value & ~(kMaxExtendedId | kErrorFlag)) != 0) return false;
  return split_id(value | kExtendedFlag, frame);
}

// Pairs of hex digits, optionally separated by dots; takes what it reads.
bool parse_bytes(std::string_view& text, CanFrame& frame) noexcept {
  const std::size_t room = frame.fd ? kMaxFdLength : kMaxClassicLength;
  std::size_t length = 0;
  while (!text.empty() && text.front() != '_') {
    if (length > 0 && text.front() == '.') text.remove_prefix(1);
    if (text.size() < 2 || length == room) return false;
    const auto high = hex_digit(text[0]);
    const auto low = hex_digit(text[1]);
    if (!high || !low) return false;
    frame.data[length++] = static_cast<std::byte>(*high << 4U | *low);
    text.remove_prefix(2);
  }
  frame.length = static_cast<std::uint8_t>(length);
  return is_valid_length(length, frame.fd);
}

// "_9" … "_F": the raw DLC of a classic frame of eight bytes. It adds no data.
bool parse_raw_dlc(std::string_view text, std::size_t length) noexcept {
  if (text.empty()) return true;
  if (text.size() != 2 || text[0] != '_' || length != kMaxClassicLength) return false;
  return hex_digit(text[1]).value_or(0) > kMaxClassicLength;
}

// "R", "R4", "R8_F"
bool parse_remote(std::string_view text, CanFrame& frame) noexcept {
  frame.remote = true;
  text.remove_prefix(1);
  if (text.empty()) return true;
  const auto requested = hex_digit(text.front());
  if (!requested || *requested > kMaxClassicLength) return false;
  return parse_raw_dlc(text.substr(1), *requested);
}

// What follows the id's '#'.
bool parse_payload(std::string_view text, CanFrame& frame) noexcept {
  if (text.starts_with('#')) {
    frame.fd = true;
    if (text.size() < 2 || !hex_digit(text[1])) return false;
    text.remove_prefix(2);
    return parse_bytes(text, frame) && text.empty();
  }
  if (text.starts_with('R') && !frame.error) return parse_remote(text, frame);
  return parse_bytes(text, frame) && parse_raw_dlc(text, frame.length);
}

// "VVPPP#FF:SS:AAAAAAAA#data", also without the VV.
bool is_can_xl(std::string_view payload) noexcept {
  constexpr std::size_t kSecondFieldOffset = 2;
  return payload.size() > kSecondFieldOffset && payload[kSecondFieldOffset] == ':';
}

CandumpStatus parse_frame(std::string_view word, CanFrame& frame) noexcept {
  const std::size_t hash = word.find('#');
  if (hash == std::string_view::npos) return CandumpStatus::bad_id;
  const std::string_view payload = word.substr(hash + 1);
  if (is_can_xl(payload)) return CandumpStatus::can_xl;
  if (!parse_id(word.substr(0, hash), frame)) return CandumpStatus::bad_id;
  return parse_payload(payload, frame) ? CandumpStatus::frame : CandumpStatus::bad_data;
}

}  // namespace

CandumpStatus parse_candump_line(std::string_view line, CandumpLine& out) noexcept {
  line = line.substr(0, line.find_last_not_of(" \t\r\n") + 1);
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  if (line.empty()) return CandumpStatus::blank;
  if (line.starts_with("DROPCOUNT:")) return CandumpStatus::drop_note;

  CandumpLine parsed;
  const auto stamp = parse_time(take_word(line));
  if (!stamp) return CandumpStatus::bad_time;
  parsed.frame.stamp = *stamp;
  parsed.interface = take_word(line);
  if (parsed.interface.empty() || parsed.interface.size() > kMaxInterfaceName) {
    return CandumpStatus::bad_name;
  }
  const CandumpStatus status = parse_frame(take_word(line), parsed.frame);
  if (status != CandumpStatus::frame) return status;
  if (line == "R") parsed.direction = Direction::received;
  if (line == "T") parsed.direction = Direction::transmitted;
  if (!line.empty() && parsed.direction == Direction::unknown) return CandumpStatus::bad_ending;
  out = parsed;
  return CandumpStatus::frame;
}

}  // namespace convexcut::can
