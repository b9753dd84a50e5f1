// SPDX-License-Identifier: Apache-2.0
//
// A reader of Prometheus's text exposition format 0.0.4
// (https://prometheus.io/docs/instrumenting/exposition_formats/), independent of the writer.
#pragma once

#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace convexcut::daemon::testing {

// Checks the text line by line; gives the samples by "name{labels}".
inline std::map<std::string, std::string> read_exposition(const std::string& text) {
  static const std::regex help(R"(# HELP ([a-zA-Z_:][a-zA-Z0-9_:]*) (\S.*))");
  static const std::regex type(
      R"(# TYPE ([a-zA-Z_:][a-zA-Z0-9_:]*) (counter|gauge|histogram|summary|untyped))");
  static const std::string one_label = R"([a-zA-Z_][a-zA-Z0-9_]*="(?:[^"\\\n]|\\[\\"n])*")";
  static const std::regex sample(R"(([a-zA-Z_:][a-zA-Z0-9_:]*)(\{)" + one_label + "(?:," +
                                 one_label +
                                 R"()*\})? ([-+]?(?:[0-9.]+(?:e[-+]?[0-9]+)?|Inf)|NaN))");
  std::map<std::string, std::string> samples;
  std::set<std::string> finished;
  std::string family;
  std::string kind;
  EXPECT_FALSE(text.empty());
  EXPECT_EQ(text.back(), '\n') << "the last line must end with a line feed";
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (std::regex_match(line, found, help)) {
      if (!family.empty()) finished.insert(family);
      family = found[1];
      kind.clear();
      EXPECT_EQ(finished.count(family), 0U) << family << " comes in two places";
    } else if (std::regex_match(line, found, type)) {
      EXPECT_EQ(found[1], family) << "TYPE belongs to the HELP before it";
      kind = found[2];
    } else if (std::regex_match(line, found, sample)) {
      EXPECT_FALSE(kind.empty()) << line << ": before its TYPE";
      std::string name = found[1];
      if (kind == "summary") name = std::regex_replace(name, std::regex("_(sum|count)$"), "");
      EXPECT_EQ(name, family) << line;
      EXPECT_EQ(kind == "counter", name.ends_with("_total")) << line;
      const std::string key = found[1].str() + found[2].str();
      EXPECT_TRUE(samples.emplace(key, found[3]).second) << key << " comes twice";
    } else {
      ADD_FAILURE() << "not a line of the format: " << line;
    }
  }
  return samples;
}

}  // namespace convexcut::daemon::testing
