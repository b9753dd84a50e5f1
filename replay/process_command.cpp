// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "daemon/command_line/arguments.hpp"
#include "replay/commands.hpp"
#include "replay/process.hpp"

namespace convexcut::replay {
namespace {

struct ProcessArguments {
  command_line::RecordingArguments recordings;
  command_line::ConfigArguments config;
  std::filesystem::path out;
  ScanFormat format = ScanFormat::pcd;
  unsigned threads = 0;
  bool json = false;
};

int run_process(const ProcessArguments& args) {
  ProcessOptions options;
  options.recordings = args.recordings.paths;
  options.config = args.config.load();
  options.out = args.out;
  options.format = args.format;
  options.threads = args.threads;
  options.json = args.json;
  process(options);
  return command_line::kDone;
}

}  // namespace

Command add_process(CLI::App& root) {
  CLI::App* app = root.add_subcommand(
      "process", "Separate a whole recording into structure and the rest, one file a scan");
  const auto args = std::make_shared<ProcessArguments>();
  args->recordings.add_to(*app, true);
  args->recordings.add_poses_to(*app);
  args->config.add_to(*app);
  app->add_option("--out", args->out, "Directory for scan_000000.pcd … and scans.csv")
      ->type_name("DIR")
      ->required();
  app->add_option("--format", args->format, "pcd (default), ply or csv")
      ->transform(CLI::CheckedTransformer(std::map<std::string, ScanFormat>{
          {"pcd", ScanFormat::pcd}, {"ply", ScanFormat::ply}, {"csv", ScanFormat::csv}}))
      ->type_name("FORMAT");
  app->add_option("--threads", args->threads, "Computing threads (default: one a core, at most 4)")
      ->check(CLI::Range(1U, 64U))
      ->type_name("N");
  app->add_flag("--json", args->json, "Print the summary as one JSON object");
  app->footer(
      "Examples:\n"
      "  convexcut process --lidar lidar.pcap --imu imu.pcap --out scans\n"
      "  convexcut process --lidar lidar.pcap --set mount.orientation=fixed --out scans --format "
      "ply");
  return {app, [args] { return run_process(*args); }};
}

}  // namespace convexcut::replay
