// SPDX-License-Identifier: Apache-2.0
#include "config/text_rules.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>

#include <system_error>

namespace convexcut::config {
namespace {

constexpr std::size_t kMaxTopicName = 246;
constexpr std::size_t kMaxFrameName = 255;
constexpr std::size_t kMaxPath = 4095;

bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

bool is_token_character(char c) noexcept {
  return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool is_token(std::string_view token) noexcept {
  return !token.empty() && !is_digit(token.front()) && token.find("__") == std::string_view::npos &&
         std::ranges::all_of(token, is_token_character);
}

// Visible ASCII.
bool is_graphic(char c) noexcept { return c > ' ' && c <= '~'; }

bool is_control(char c) noexcept { return (c >= '\0' && c < ' ') || c == '\x7F'; }

}  // namespace

bool is_topic_name(std::string_view text) noexcept {
  if (text.size() > kMaxTopicName) return false;
  for (;;) {
    const std::size_t slash = text.find('/');
    if (!is_token(text.substr(0, slash))) return false;
    if (slash == std::string_view::npos) return true;
    text.remove_prefix(slash + 1);
  }
}

bool is_frame_name(std::string_view text) noexcept {
  return !text.empty() && text.size() <= kMaxFrameName && text.front() != '/' &&
         std::ranges::all_of(text, is_graphic);
}

bool is_path_or_empty(std::string_view text) noexcept {
  return text.size() <= kMaxPath && std::ranges::none_of(text, is_control);
}

std::optional<std::uint32_t> parse_ipv4(std::string_view text) noexcept {
  std::uint32_t address = 0;
  const char* next = text.data();
  const char* const end = text.data() + text.size();
  for (int octet = 0; octet < 4; ++octet) {
    if (octet > 0 && (next == end || *next++ != '.')) return std::nullopt;
    std::uint8_t value = 0;
    const auto [stop, error] = std::from_chars(next, end, value);
    if (error != std::errc{} || (*next == '0' && stop - next > 1)) return std::nullopt;
    address = (address << 8U) | value;
    next = stop;
  }
  return next == end ? std::optional(address) : std::nullopt;
}

bool is_ipv4(std::string_view text) noexcept { return parse_ipv4(text).has_value(); }
bool is_ipv4_or_empty(std::string_view text) noexcept { return text.empty() || is_ipv4(text); }

bool is_multicast_or_empty(std::string_view text) noexcept {
  constexpr std::uint32_t kClassMask = 0xF0000000;
  constexpr std::uint32_t kClassD = 0xE0000000;
  const std::optional<std::uint32_t> address = parse_ipv4(text);
  return text.empty() || (address && (*address & kClassMask) == kClassD);
}

bool is_interface_or_empty(std::string_view text) noexcept {
  constexpr std::size_t kMaxInterfaceName = 15;  // IFNAMSIZ with its end
  if (text == "." || text == "..") return false;
  return text.size() <= kMaxInterfaceName && std::ranges::all_of(text, is_graphic) &&
         text.find_first_of("/:") == std::string_view::npos;
}

std::optional<CpuSet> parse_cpus(std::string_view text) noexcept {
  CpuSet cpus;
  const char* at = text.data();
  const char* const end = at + text.size();
  const auto number = [&at, end, &cpus](std::size_t& value) {
    const auto [next, error] = std::from_chars(at, end, value);
    at = next;
    return error == std::errc{} && value < cpus.size();
  };
  for (;;) {
    std::size_t first = 0;
    if (!number(first)) return std::nullopt;
    std::size_t last = first;
    if (at != end && *at == '-') {
      ++at;
      if (!number(last) || last < first) return std::nullopt;
    }
    for (std::size_t cpu = first; cpu <= last; ++cpu) cpus.set(cpu);
    if (at == end) return cpus;
    if (*at++ != ',') return std::nullopt;
  }
}

bool is_cpus_or_empty(std::string_view text) noexcept { return text.empty() || parse_cpus(text); }

}  // namespace convexcut::config
