// SPDX-License-Identifier: Apache-2.0
#include "config/value_text.hpp"

#include <array>
#include <charconv>

namespace convexcut::config {
namespace {

constexpr std::string_view kHexDigits = "0123456789ABCDEF";

bool is_control(char c) noexcept { return (c >= '\0' && c < ' ') || c == '\x7F'; }

void append_escaped(std::string& out, char c) {
  switch (c) {
    case '\n':
      out += "\\n";
      return;
    case '\r':
      out += "\\r";
      return;
    case '\t':
      out += "\\t";
      return;
    default:
      break;
  }
  const auto code = static_cast<unsigned char>(c);
  out += "\\u00";
  out += kHexDigits[code >> 4U];
  out += kHexDigits[code & 0x0FU];
}

// Not in the middle of a UTF-8 sequence.
std::string_view cut(std::string_view text, std::size_t limit) noexcept {
  const auto continues = [&](std::size_t i) {
    return (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
  };
  while (limit > 0 && continues(limit)) --limit;
  return text.substr(0, limit);
}

}  // namespace

std::string integer_text(std::int64_t value, Integer::Notation notation) {
  const bool hexadecimal = notation == Integer::Notation::hexadecimal && value >= 0;
  std::array<char, 24> digits{};
  const auto result =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, hexadecimal ? 16 : 10);
  return concat(hexadecimal ? "0x" : "", std::string_view(digits.data(), result.ptr));
}

std::string number_text(double value) {
  std::array<char, 32> digits{};
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return {digits.data(), result.ptr};
}

std::string printable(std::string_view text, std::size_t limit) {
  std::string out;
  for (const char c : text.size() > limit ? cut(text, limit) : text) {
    if (is_control(c)) {
      append_escaped(out, c);
    } else {
      out += c;
    }
  }
  if (text.size() > limit) out += "…";
  return out;
}

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (is_control(c)) {
      append_escaped(out, c);
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

}  // namespace convexcut::config
