// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "daemon/command_line/arguments.hpp"
#include "replay/commands.hpp"
#include "replay/info.hpp"

namespace convexcut::replay {
namespace {

struct Arguments {
  command_line::RecordingArguments recordings;
  command_line::ConfigArguments config;
  bool json = false;
};

int run(const Arguments& args) {
  const daemon::RecordingPaths& paths = args.recordings.paths;
  if (paths.lidar.empty() && paths.imu.empty() && paths.can.empty()) {
    throw command_line::UsageError("nothing to look at: expected --lidar, --imu or --can");
  }
  info({paths, args.config.load(), args.json});
  return command_line::kDone;
}

}  // namespace

Command add_info(CLI::App& root) {
  CLI::App* app = root.add_subcommand("info", "Say what is in recordings, and how good they are");
  const auto args = std::make_shared<Arguments>();
  args->recordings.add_to(*app, false);
  args->config.add_to(*app);
  app->add_flag("--json", args->json, "Print one JSON object");
  app->footer(
      "Examples:\n"
      "  convexcut info --lidar lidar.pcap\n"
      "  convexcut info --imu imu.bin --json");
  return {app, [args] { return run(*args); }};
}

}  // namespace convexcut::replay
