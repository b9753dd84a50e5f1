// SPDX-License-Identifier: Apache-2.0
//
// convexcutd: the daemon. See `convexcutd --help`.
#include <csignal>

#include "daemon/command_line/arguments.hpp"
#include "daemon/command_line/rate.hpp"
#include "daemon/daemon.hpp"
#include "daemon/log/log.hpp"

namespace {

using namespace convexcut;

// Every thread inherits this: only Daemon::run() takes the signals, by asking for them.
void block_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGUSR1);
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

struct Arguments {
  command_line::RecordingArguments recordings;
  command_line::ConfigArguments config;
  std::string rate = "1";
  double wait_for_reader_s = 0.0;
  std::string record;
};

int run(const Arguments& args) {
  daemon::DaemonOptions options;
  options.config = args.config.load();
  options.rate = command_line::parse_rate(args.rate);
  options.recordings = args.recordings.paths;
  if (options.recordings.lidar.empty() &&
      !(options.recordings.imu.empty() && options.recordings.can.empty() &&
        options.recordings.poses.empty())) {
    throw command_line::UsageError(
        "expected --lidar FILE beside --imu, --can or --poses, or none of them to run live");
  }
  if (!args.record.empty()) {
    if (!options.recordings.lidar.empty()) {
      throw command_line::UsageError("--record: expected live input, not a recording (--lidar)");
    }
    options.config.record.directory = args.record;
  }
  options.wait_for_reader = Duration{static_cast<Duration::rep>(args.wait_for_reader_s * 1e9)};
  daemon::log::set_level(options.config.log.level);
  block_signals();
  daemon::Daemon(options).run();
  return command_line::kDone;
}

int program(int argc, char** argv) {
  CLI::App root(
      "Publishes the structure of a room (walls, floor, ceiling) over DDS, ten times a second, "
      "from a "
      "Velodyne lidar and an Xsens IMU.",
      "convexcutd");
  root.set_version_flag("--version", "convexcutd " CONVEXCUT_VERSION);
  Arguments args;
  args.recordings.add_to(root, false);
  args.recordings.add_poses_to(root);
  args.config.add_to(root);
  root.add_option("--rate", args.rate, "Recorded seconds per second, or max (default 1)")
      ->type_name("X|max");
  root.add_option("--wait-for-reader", args.wait_for_reader_s,
                  "Start when somebody listens, or after this time (default 0)")
      ->check(CLI::Range(0.0, 3600.0))
      ->type_name("SECONDS");
  root.add_option("--record", args.record,
                  "Record the live input in this directory (as record.directory)")
      ->type_name("DIR");
  root.footer(
      "Without --lidar it runs live, on the sensors that the configuration names.\n"
      "SIGUSR1 writes all that it knows of its health to the log.\n"
      "Exit status: 0 done, 1 failed while running, 2 wrong usage or configuration.\n"
      "Examples:\n"
      "  convexcutd --set imu.device=/dev/ttyUSB0\n"
      "  convexcutd --lidar lidar.pcap --imu imu.pcap &\n"
      "  convexcut watch");
  return command_line::run_program(root, argc, argv, [&args] { return run(args); });
}

}  // namespace

int main(int argc, char** argv) {
  return command_line::guarded([argc, argv] { return program(argc, argv); });
}
