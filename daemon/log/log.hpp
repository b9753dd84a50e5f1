// SPDX-License-Identifier: Apache-2.0
//
// The daemon's log: structured lines on stderr, one write(2) a line, so that lines of several
// threads and programs never mix. Any thread but a realtime one: it formats, allocates and writes.
//
//   log::warning("publish_timeout", {{"topic", name}, {"count", n}});
//
// Under systemd (stderr is the stream that JOURNAL_STREAM names) lines carry journald priorities.
#pragma once

#include <initializer_list>
#include <span>
#include <string_view>

#include "config/config.hpp"
#include "daemon/log/line.hpp"

namespace convexcut::daemon::log {

// Lines above this level are dropped; info until set. Any thread.
void set_level(config::LogLevel level) noexcept;
[[nodiscard]] bool enabled(config::LogLevel level) noexcept;

// Events are named as data: lower case, words joined by '_'.
void write(config::LogLevel level, std::string_view event, std::span<const Field> fields);
inline void write(config::LogLevel level, std::string_view event,
                  std::initializer_list<Field> fields) {
  write(level, event, std::span(fields.begin(), fields.size()));
}

inline void error(std::string_view event, std::initializer_list<Field> fields = {}) {
  write(config::LogLevel::error, event, fields);
}
inline void warning(std::string_view event, std::initializer_list<Field> fields = {}) {
  write(config::LogLevel::warning, event, fields);
}
inline void info(std::string_view event, std::initializer_list<Field> fields = {}) {
  write(config::LogLevel::info, event, fields);
}
inline void debug(std::string_view event, std::initializer_list<Field> fields = {}) {
  write(config::LogLevel::debug, event, fields);
}

// Whether stderr is connected to the journal: journal_stream is the value of JOURNAL_STREAM,
// "device:inode", null when unset (systemd.exec(5)).
[[nodiscard]] Destination stderr_destination(const char* journal_stream) noexcept;

}  // namespace convexcut::daemon::log
