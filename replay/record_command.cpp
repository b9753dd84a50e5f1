// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include "daemon/command_line/arguments.hpp"
#include "replay/commands.hpp"
#include "replay/record.hpp"

namespace convexcut::replay {
namespace {

struct RecordArguments {
  command_line::ConfigArguments config;
  std::string out;
  std::optional<double> seconds;
  bool json = false;
};

int run_record(const RecordArguments& args) {
  RecordOptions options;
  options.config = args.config.load();
  if (!args.out.empty()) options.config.record.directory = args.out;
  if (options.config.record.directory.empty()) {
    throw command_line::UsageError(
        "expected a directory to record to: --out DIR, or record.directory in the configuration");
  }
  if (args.seconds) {
    options.duration = Duration{static_cast<Duration::rep>(*args.seconds * 1e9)};
  }
  options.json = args.json;
  return record(options);
}

}  // namespace

Command add_record(CLI::App& root) {
  CLI::App* app = root.add_subcommand(
      "record", "Record live sensors to captures, without computing anything from them");
  const auto args = std::make_shared<RecordArguments>();
  args->config.add_to(*app);
  app->add_option("--out", args->out,
                  "Directory for lidar_000.pcap, imu_000.pcap … (default record.directory)")
      ->type_name("DIR");
  app->add_option("--seconds", args->seconds, "Stop after this time (default: at Ctrl-C)")
      ->check(CLI::Range(0.0, 1e9))
      ->type_name("S");
  app->add_flag("--json", args->json, "Print the counts as one JSON object");
  app->footer(
      "Exit status 1: nothing was recorded, or something is missing from the recording.\n"
      "Examples:\n"
      "  convexcut record --out drive --set imu.device=/dev/ttyUSB0\n"
      "  convexcut process --lidar drive/lidar_000.pcap --imu drive/imu_000.pcap --out scans");
  return {app, [args] { return run_record(*args); }};
}

}  // namespace convexcut::replay
