// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace convexcut::command_line {

// The exit status of every program of the project.
enum ExitStatus : int {
  kDone = 0,
  kFailed = 1,  // while running: a file, a device, a topic
  kUsage = 2,   // the command line or the configuration
};

// Wrong usage that only shows when arguments are looked at together. One line.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace convexcut::command_line
