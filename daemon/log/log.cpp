// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/log.hpp"

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <string>

#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace convexcut::daemon::log {
namespace {

// Relaxed: a threshold orders nothing; set_level() pairs with enabled().
std::atomic<config::LogLevel> threshold{config::LogLevel::info};

template <class T>
bool parse_whole(std::string_view text, T& value) {
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  return result.ec == std::errc{} && result.ptr == end;
}

// A line that stderr does not take is lost: there is nowhere left to report it.
void write_once(std::string_view line) noexcept {
  while (::write(STDERR_FILENO, line.data(), line.size()) < 0 && errno == EINTR) {
  }
}

}  // namespace

void set_level(config::LogLevel level) noexcept {
  threshold.store(level, std::memory_order_relaxed);
}

bool enabled(config::LogLevel level) noexcept {
  return level <= threshold.load(std::memory_order_relaxed);
}

void write(config::LogLevel level, std::string_view event, std::span<const Field> fields) {
  if (!enabled(level)) return;
  static const Destination destination = stderr_destination(std::getenv("JOURNAL_STREAM"));
  write_once(format_line(destination, level, event, fields));
}

Destination stderr_destination(const char* journal_stream) noexcept {
  if (journal_stream == nullptr) return Destination::plain;
  const std::string_view text(journal_stream);
  const std::size_t colon = text.find(':');
  dev_t device = 0;
  ino_t inode = 0;
  if (colon == std::string_view::npos || !parse_whole(text.substr(0, colon), device) ||
      !parse_whole(text.substr(colon + 1), inode)) {
    return Destination::plain;
  }
  struct stat actual {};
  const bool same =
      ::fstat(STDERR_FILENO, &actual) == 0 && actual.st_dev == device && actual.st_ino == inode;
  return same ? Destination::journal : Destination::plain;
}

}  // namespace convexcut::daemon::log
