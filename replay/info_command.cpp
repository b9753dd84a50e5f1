// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>
#include <string>

#include "core/simd/simd_path.hpp"
#include "daemon/command_line/arguments.hpp"
#include "replay/commands.hpp"
#include "replay/info.hpp"

namespace convexcut::replay {
namespace {

struct InfoArguments {
  command_line::RecordingArguments recordings;
  command_line::ConfigArguments config;
  bool cpu = false;
  bool json = false;
};

// The instruction set that the kernels run with, and those that could be forced.
void print_cpu(bool json) {
  std::string available;
  for (const std::string_view path : simd_paths()) {
    if (!available.empty()) available += json ? ", " : " ";
    available += json ? '"' + std::string(path) + '"' : std::string(path);
  }
  const std::string in_use(simd_path());
  std::printf(
      json ? "{\"simd\": \"%s\", \"available\": [%s]}\n" : "SIMD path in use: %s\navailable: %s\n",
      in_use.c_str(), available.c_str());
}

int run_info(const InfoArguments& args) {
  const daemon::RecordingPaths& paths = args.recordings.paths;
  const config::Config config = args.config.load();
  if (args.cpu) {
    print_cpu(args.json);
    return command_line::kDone;
  }
  if (paths.lidar.empty() && paths.imu.empty() && paths.can.empty()) {
    throw command_line::UsageError("nothing to look at: expected --lidar, --imu, --can or --cpu");
  }
  info({paths, config, args.json});
  return command_line::kDone;
}

}  // namespace

Command add_info(CLI::App& root) {
  CLI::App* app = root.add_subcommand("info", "Say what is in recordings, and how good they are");
  const auto args = std::make_shared<InfoArguments>();
  args->recordings.add_to(*app, false);
  args->config.add_to(*app);
  app->add_flag("--cpu", args->cpu,
                "Say which instruction set is computed with (forced by --set convex_cut.simd=…)");
  app->add_flag("--json", args->json, "Print one JSON object");
  app->footer(
      "Examples:\n"
      "  convexcut info --lidar lidar.pcap\n"
      "  convexcut info --imu imu.bin --json\n"
      "  convexcut info --cpu");
  return {app, [args] { return run_info(*args); }};
}

}  // namespace convexcut::replay
