// SPDX-License-Identifier: Apache-2.0
//
// The subcommands of `convexcut`: each adds its options to the command line and runs when it was
// chosen.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace convexcut::replay {

struct Command {
  CLI::App* app = nullptr;
  std::function<int()> run;  // gives the exit status; may throw
};

[[nodiscard]] Command add_process(CLI::App& root);
[[nodiscard]] Command add_replay(CLI::App& root);
[[nodiscard]] Command add_record(CLI::App& root);
[[nodiscard]] Command add_simulate(CLI::App& root);
[[nodiscard]] Command add_info(CLI::App& root);
[[nodiscard]] Command add_watch(CLI::App& root);
[[nodiscard]] Command add_picture(CLI::App& root);
[[nodiscard]] Command add_evaluate(CLI::App& root);

}  // namespace convexcut::replay
