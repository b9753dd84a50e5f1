// SPDX-License-Identifier: Apache-2.0
//
// What the command lines of all programs have in common.
#pragma once

#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "config/config.hpp"
#include "daemon/command_line/exit_status.hpp"
#include "daemon/sources/recordings.hpp"

namespace convexcut::command_line {

// --config and --set.
struct ConfigArguments {
  std::optional<std::filesystem::path> file;
  std::vector<std::string> overrides;

  void add_to(CLI::App& app);
  // And lets the program compute with the instruction set that is asked for. Throws
  // config::ConfigError, and UsageError when the processor has none such.
  [[nodiscard]] config::Config load() const;
};

// --lidar, --imu, --can and --imu-start.
struct RecordingArguments {
  daemon::RecordingPaths paths;

  void add_to(CLI::App& app, bool lidar_required);
  // --poses, of programs that use them.
  void add_poses_to(CLI::App& app);
};

// A program's body: parses, runs, and turns exceptions into one line on stderr and an exit status.
[[nodiscard]] int run_program(CLI::App& root, int argc, char** argv,
                              const std::function<int()>& run);

// What main() is made of: no exception leaves it.
template <class Program>
[[nodiscard]] int guarded(Program&& program) noexcept {
  try {
    return std::forward<Program>(program)();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  } catch (...) {
    std::fputs("an unknown error\n", stderr);
  }
  return kFailed;
}

}  // namespace convexcut::command_line
