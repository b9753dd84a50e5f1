// SPDX-License-Identifier: Apache-2.0
//
// A reader of Prometheus's text exposition format 0.0.4
// (https://prometheus.io/docs/instrumenting/exposition_formats/), independent of the writer.
#pragma once

#include <charconv>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace convexcut::daemon::testing {

class ExpositionReader {
 public:
  // Checks the text line by line; gives the samples by "name{labels}".
  std::map<std::string, std::string> read(const std::string& text) {
    EXPECT_TRUE(text.ends_with('\n')) << "the last line must end with a line feed";
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const bool good = line.starts_with("# HELP ")   ? take_help(line.substr(7))
                        : line.starts_with("# TYPE ") ? take_type(line.substr(7))
                                                      : take_sample(line);
      EXPECT_TRUE(good) << "not a line of the format, or not in its place: " << line;
    }
    return samples_;
  }

 private:
  static bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  }
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }

  // The name at the front of `rest`, taken from it; empty when there is none.
  static std::string take_name(std::string_view& rest) {
    std::size_t size = 0;
    while (size < rest.size() &&
           (is_letter(rest[size]) || rest[size] == ':' || (size > 0 && is_digit(rest[size])))) {
      ++size;
    }
    const std::string name(rest.substr(0, size));
    rest.remove_prefix(size);
    return name;
  }
  static bool take(std::string_view& rest, std::string_view expected) {
    if (!rest.starts_with(expected)) return false;
    rest.remove_prefix(expected.size());
    return true;
  }
  // "value" with \\, \" and \n as its only escapes.
  static bool take_quoted(std::string_view& rest) {
    if (!take(rest, "\"")) return false;
    while (!rest.empty() && rest.front() != '"') {
      const std::size_t size = rest.front() == '\\' ? 2 : 1;
      if (rest.size() < size) return false;
      if (size == 2 && std::string_view("\\\"n").find(rest[1]) == std::string_view::npos) {
        return false;
      }
      rest.remove_prefix(size);
    }
    return take(rest, "\"");
  }
  static bool take_labels(std::string_view& rest) {
    if (!take(rest, "{")) return true;
    do {
      const std::string name = take_name(rest);
      if (name.empty() || name.find(':') != std::string::npos) return false;
      if (!take(rest, "=") || !take_quoted(rest)) return false;
    } while (take(rest, ","));
    return take(rest, "}");
  }
  static bool is_number(std::string_view text) {
    if (text == "NaN" || text == "+Inf" || text == "-Inf") return true;
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size();
  }

  bool take_help(std::string_view rest) {
    family_ = take_name(rest);
    kind_.clear();
    // All lines of a metric stand together.
    return !family_.empty() && families_.insert(family_).second && rest.size() > 1 &&
           rest.front() == ' ';
  }
  bool take_type(std::string_view rest) {
    const std::string name = take_name(rest);
    kind_ = rest.empty() ? rest : rest.substr(1);
    return name == family_ && (kind_ == "counter" || kind_ == "gauge" || kind_ == "summary");
  }
  bool take_sample(std::string_view line) {
    std::string_view rest = line;
    std::string name = take_name(rest);
    if (!take_labels(rest)) return false;
    const std::string key(line.substr(0, line.size() - rest.size()));
    if (!take(rest, " ") || !is_number(rest)) return false;
    for (const char* const suffix : {"_sum", "_count"}) {
      if (kind_ == "summary" && name == family_ + suffix) name = family_;
    }
    return !kind_.empty() && name == family_ && (kind_ == "counter") == name.ends_with("_total") &&
           samples_.emplace(key, rest).second;
  }

  std::string family_;
  std::string kind_;
  std::set<std::string> families_;
  std::map<std::string, std::string> samples_;
};

inline std::map<std::string, std::string> read_exposition(const std::string& text) {
  return ExpositionReader().read(text);
}

}  // namespace convexcut::daemon::testing
