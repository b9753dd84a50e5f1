// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/line.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace convexcut::daemon::log {
namespace {

constexpr std::string_view kCut = "…";

std::string_view level_name(config::LogLevel level) {
  switch (level) {
    case config::LogLevel::error:
      return "error";
    case config::LogLevel::warning:
      return "warning";
    case config::LogLevel::info:
      return "info";
    case config::LogLevel::debug:
      return "debug";
  }
  return "info";
}

// sd-daemon(3), SD_ERR … SD_DEBUG.
std::string_view journal_priority(config::LogLevel level) {
  switch (level) {
    case config::LogLevel::error:
      return "<3>";
    case config::LogLevel::warning:
      return "<4>";
    case config::LogLevel::info:
      return "<6>";
    case config::LogLevel::debug:
      return "<7>";
  }
  return "<6>";
}

// Bytes from 0x80 on are parts of UTF-8 characters and stand as they are.
bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte == 0x7f;
}

bool needs_quotes(std::string_view text) {
  return text.empty() || std::any_of(text.begin(), text.end(), [](char c) {
           return is_control(c) || c == ' ' || c == '"' || c == '\\' || c == '=';
         });
}

void append_escaped(std::string& line, char c) {
  static constexpr std::string_view kHex = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(c);
  if (c == '"' || c == '\\') {
    line += '\\';
    line += c;
  } else if (c == '\n') {
    line += "\\n";
  } else if (c == '\t') {
    line += "\\t";
  } else if (is_control(c)) {
    line += "\\x";
    line += kHex[byte >> 4U];
    line += kHex[byte & 0xfU];
  } else {
    line += c;
  }
}

// Not inside a UTF-8 character: its later bytes are 10xxxxxx.
std::size_t cut_position(std::string_view line, std::size_t at) {
  while (at > 0 && (static_cast<unsigned char>(line[at]) & 0xc0U) == 0x80U) --at;
  return at;
}

}  // namespace

Field::Field(std::string_view key, std::string_view value) : key_(key), text_(value) {}

Field::Field(std::string_view key, double value) : key_(key) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  text_.assign(text.data(), end.ptr);
}

void Field::append_to(std::string& line) const {
  line += ' ';
  line += key_;
  line += '=';
  if (!needs_quotes(text_)) {
    line += text_;
    return;
  }
  line += '"';
  for (const char c : text_) append_escaped(line, c);
  line += '"';
}

std::string format_line(Destination destination, config::LogLevel level, std::string_view event,
                        std::span<const Field> fields) {
  std::string line;
  if (destination == Destination::journal) {
    line += journal_priority(level);
  } else {
    line += level_name(level);
    line += ' ';
  }
  for (const char c : event) append_escaped(line, c);
  for (const Field& field : fields) field.append_to(line);
  if (line.size() + 1 > kMaxLineBytes) {
    line.resize(cut_position(line, kMaxLineBytes - 1 - kCut.size()));
    line += kCut;
  }
  line += '\n';
  return line;
}

}  // namespace convexcut::daemon::log
