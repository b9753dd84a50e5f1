// SPDX-License-Identifier: Apache-2.0
//
// The text of one log line: `level event key=value key="quoted value"`, without a time (the journal
// and the terminal's user have one). Pure: writes nothing.
#pragma once

#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include "config/config.hpp"

namespace convexcut::daemon::log {

// A value is turned to text on construction: numbers as the shortest text that reads back equal.
class Field {
 public:
  Field(std::string_view key, std::string_view value);
  Field(std::string_view key, const char* value) : Field(key, std::string_view(value)) {}
  Field(std::string_view key, bool value) : key_(key), text_(value ? "true" : "false") {}
  Field(std::string_view key, double value);
  template <std::integral T>
  Field(std::string_view key, T value) : key_(key), text_(std::to_string(value)) {}

  // Appends ` key=value`; a value is quoted when it is empty or holds anything but plain
  // characters.
  void append_to(std::string& line) const;

 private:
  std::string_view key_;  // of the caller: a literal, or alive for the call
  std::string text_;
};

enum class Destination : unsigned char {
  plain,    // the level is spelled out
  journal,  // the level is the syslog priority in front, <3> … <7>, which journald strips
};

// Lines are cut here, marked with "…": a pipe takes up to 4096 bytes (PIPE_BUF) as one piece.
inline constexpr std::size_t kMaxLineBytes = 4096;

// The line with its newline. Control bytes, quotes and backslashes of the values are escaped, so a
// line is always one line.
[[nodiscard]] std::string format_line(Destination destination, config::LogLevel level,
                                      std::string_view event, std::span<const Field> fields);
[[nodiscard]] inline std::string format_line(Destination destination, config::LogLevel level,
                                             std::string_view event,
                                             std::initializer_list<Field> fields) {
  return format_line(destination, level, event, std::span(fields.begin(), fields.size()));
}

}  // namespace convexcut::daemon::log
