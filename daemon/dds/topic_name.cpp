// SPDX-License-Identifier: Apache-2.0
#include "daemon/dds/topic_name.hpp"

#include <algorithm>

#include "daemon/dds/entity.hpp"

namespace convexcut::daemon {
namespace {

// Not <cctype>: its answers depend on the locale.
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_token(std::string_view token) {
  return !token.empty() && is_letter(token.front()) &&
         std::all_of(token.begin(), token.end(),
                     [](char c) { return is_letter(c) || is_digit(c); });
}

}  // namespace

std::string dds_topic_name(std::string_view ros_name) {
  std::string_view rest = ros_name;
  if (rest.starts_with('/')) rest.remove_prefix(1);
  std::string name = "rt/" + std::string(rest);
  while (true) {
    const std::size_t slash = rest.find('/');
    if (!is_token(rest.substr(0, slash))) {
      throw DdsError("topic name \"" + std::string(ros_name) +
                     "\": expected tokens of letters, digits and '_', not starting with a digit, "
                     "separated by '/'");
    }
    if (slash == std::string_view::npos) return name;
    rest.remove_prefix(slash + 1);
  }
}

}  // namespace convexcut::daemon
