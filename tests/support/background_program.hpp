// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

#include "tests/support/recordings.hpp"
#include "tests/support/run_program.hpp"

namespace convexcut::test {

// A program of the build (build/PRESET/bin/NAME) that runs beside the test; killed at the end if it
// still does.
class BackgroundProgram {
 public:
  BackgroundProgram(const std::string& name, const std::vector<std::string>& arguments,
                    const ProgramLimits& limits = {});
  ~BackgroundProgram();
  BackgroundProgram(const BackgroundProgram&) = delete;
  BackgroundProgram& operator=(const BackgroundProgram&) = delete;

  [[nodiscard]] pid_t pid() const noexcept { return pid_; }
  [[nodiscard]] std::string err() const;
  // Returns when `text` has been written to stderr; false when the program ends without it.
  [[nodiscard]] bool wait_for(const std::string& text);
  void send(int signal) const;
  // Sends SIGTERM and waits for the end.
  ProgramResult stop();

 private:
  [[nodiscard]] bool ended();

  TemporaryDirectory directory_;
  pid_t pid_ = -1;
  int status_ = 0;
  bool ended_ = false;
};

}  // namespace convexcut::test
