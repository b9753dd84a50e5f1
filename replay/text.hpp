// SPDX-License-Identifier: Apache-2.0
//
// Small pieces of text for people and for programs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.hpp"

namespace convexcut::replay {

// "2011-10-28 01:20:48.284 UTC"
[[nodiscard]] std::string utc(HostTime time);

// 1234567 → "1,234,567"
[[nodiscard]] std::string grouped(std::uint64_t number);

// printf-style.
[[nodiscard]] [[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

[[nodiscard]] inline double seconds(Duration duration) noexcept {
  return static_cast<double>(duration.count()) * 1e-9;
}

[[nodiscard]] inline double milliseconds(Duration duration) noexcept {
  return std::chrono::duration<double, std::milli>(duration).count();
}

// One JSON object on one line, in the order of the calls.
class JsonObject {
 public:
  JsonObject& add(std::string_view key, std::string_view text);
  JsonObject& add(std::string_view key, const char* text) {
    return add(key, std::string_view(text));
  }
  JsonObject& add(std::string_view key, std::uint64_t number);
  JsonObject& add(std::string_view key, double number, int decimals);
  JsonObject& add(std::string_view key, bool yes);
  JsonObject& add(std::string_view key, const JsonObject& object);
  JsonObject& add(std::string_view key, const std::vector<JsonObject>& objects);
  [[nodiscard]] std::string text() const { return "{" + members_ + "}"; }

 private:
  JsonObject& add_raw(std::string_view key, const std::string& value);
  std::string members_;
};

}  // namespace convexcut::replay
