// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace convexcut::test {

struct ProgramResult {
  int status = -1;  // exit status; 128 + signal when a signal ended it
  std::string out;
  std::string err;

  [[nodiscard]] std::size_t error_lines() const;
};

struct ProgramLimits {
  std::string terminate_at;  // sends SIGTERM when this has been written; empty: never
  long file_size_bytes =
      -1;  // RLIMIT_FSIZE, with SIGXFSZ ignored: writing beyond fails like a full disk
};

// Runs a program of the build (build/PRESET/bin/NAME) to its end.
[[nodiscard]] ProgramResult run_program(const std::string& name,
                                        const std::vector<std::string>& arguments,
                                        const ProgramLimits& limits = {});

// What run_program() is made of. Starts the program, whose output goes to the files `out` and `err`
// in `directory`; and reads these when it has ended with a status of waitpid().
[[nodiscard]] pid_t start_program(const std::string& name,
                                  const std::vector<std::string>& arguments,
                                  const ProgramLimits& limits,
                                  const std::filesystem::path& directory);
[[nodiscard]] ProgramResult program_result(int status, const std::filesystem::path& directory);

}  // namespace convexcut::test
