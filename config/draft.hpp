// SPDX-License-Identifier: Apache-2.0
//
// A configuration in the making: takes assignments one by one and collects what is wrong with them.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "config/config.hpp"
#include "config/schema.hpp"

namespace convexcut::config {

// What was found where a value was expected.
struct Found {
  Value value;
  std::string_view other{};  // what it is when it is no value: "an array"
};

class Draft {
 public:
  // `place` goes before the message: "robot.toml:12: lidar.model".
  void assign(const Key& key, const Found& found, std::string place);
  void report(std::string_view place, std::string_view message);

  // A part of the assignments is not known: conflicts would be guesses, and are not reported.
  void mark_incomplete() noexcept { complete_ = false; }

  // The configuration; throws ConfigError with all that was reported, and with the conflicts
  // between the values that were taken.
  [[nodiscard]] Config finish();

 private:
  struct Source {
    std::size_t order = 0;  // of the last assignment
    std::string place;
    bool wrong = false;
  };

  void report_conflicts();

  Config config_;
  std::map<std::string_view, Source> sources_;  // of the keys that were assigned
  std::size_t assignments_ = 0;
  bool complete_ = true;
  std::vector<std::string> errors_;
};

}  // namespace convexcut::config
