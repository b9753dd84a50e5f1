// SPDX-License-Identifier: Apache-2.0
#include "replay/text.hpp"

#include <cstdarg>
#include <cstdio>
#include <ctime>

namespace convexcut::replay {
namespace {

std::string json_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += format("\\u%04x", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

}  // namespace

std::string utc(HostTime time) {
  const std::int64_t ns = to_ns(time);
  std::time_t whole = static_cast<std::time_t>(ns / 1'000'000'000);
  std::int64_t rest = ns % 1'000'000'000;
  if (rest < 0) {
    rest += 1'000'000'000;
    --whole;
  }
  std::tm parts{};
  ::gmtime_r(&whole, &parts);
  return format("%04d-%02d-%02d %02d:%02d:%02d.%03d UTC", parts.tm_year + 1900, parts.tm_mon + 1,
                parts.tm_mday, parts.tm_hour, parts.tm_min, parts.tm_sec,
                static_cast<int>(rest / 1'000'000));
}

std::string grouped(std::uint64_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, 1, ',');
  return digits;
}

std::string format(const char* pattern, ...) {
  std::va_list arguments;
  std::va_list again;
  va_start(arguments, pattern);
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, pattern, arguments);
  va_end(arguments);
  std::string text(length > 0 ? static_cast<std::size_t>(length) : 0, '\0');
  std::vsnprintf(text.data(), text.size() + 1, pattern, again);
  va_end(again);
  return text;
}

JsonObject& JsonObject::add_raw(std::string_view key, const std::string& value) {
  if (!members_.empty()) members_ += ", ";
  members_ += json_string(key) + ": " + value;
  return *this;
}

JsonObject& JsonObject::add(std::string_view key, std::string_view text) {
  return add_raw(key, json_string(text));
}
JsonObject& JsonObject::add(std::string_view key, std::uint64_t number) {
  return add_raw(key, std::to_string(number));
}
JsonObject& JsonObject::add(std::string_view key, double number, int decimals) {
  return add_raw(key, format("%.*f", decimals, number));
}
JsonObject& JsonObject::add(std::string_view key, bool yes) {
  return add_raw(key, yes ? "true" : "false");
}
JsonObject& JsonObject::add(std::string_view key, const JsonObject& object) {
  return add_raw(key, object.text());
}
JsonObject& JsonObject::add(std::string_view key, const std::vector<JsonObject>& objects) {
  std::string list = "[";
  for (const JsonObject& object : objects) list += (list.size() > 1 ? ", " : "") + object.text();
  return add_raw(key, list + "]");
}

}  // namespace convexcut::replay
