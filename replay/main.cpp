// SPDX-License-Identifier: Apache-2.0
//
// convexcut: the command-line tool. See `convexcut --help`.
#include <array>

#include "daemon/command_line/arguments.hpp"
#include "replay/commands.hpp"

namespace {

using namespace convexcut;  // a program's main file: nobody includes it

int program(int argc, char** argv) {
  CLI::App root(
      "Separates a room's structure (walls, floor, ceiling) from everything in it, in the data of "
      "a "
      "Velodyne lidar and an Xsens IMU.",
      "convexcut");
  root.set_version_flag("--version", "convexcut " CONVEXCUT_VERSION);
  root.require_subcommand(1);
  root.footer(
      "Exit status: 0 done, 1 failed while running, 2 wrong usage or configuration.\n"
      "Start with:  convexcut info --lidar lidar.pcap");
  const std::array commands{replay::add_process(root),  replay::add_record(root),
                            replay::add_replay(root),   replay::add_info(root),
                            replay::add_watch(root),    replay::add_picture(root),
                            replay::add_simulate(root), replay::add_evaluate(root)};
  return command_line::run_program(root, argc, argv, [&commands] {
    for (const replay::Command& command : commands) {
      if (command.app->parsed()) return command.run();
    }
    return static_cast<int>(command_line::kUsage);
  });
}

}  // namespace

int main(int argc, char** argv) {
  return command_line::guarded([argc, argv] { return program(argc, argv); });
}
