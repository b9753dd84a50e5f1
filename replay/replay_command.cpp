// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "daemon/command_line/arguments.hpp"
#include "daemon/command_line/rate.hpp"
#include "replay/commands.hpp"
#include "replay/replay.hpp"

namespace convexcut::replay {
namespace {

constexpr double kLongest = 1e6;  // s; far from where nanoseconds end

struct ReplayArguments {
  command_line::RecordingArguments recordings;
  command_line::ConfigArguments config;
  ReplayOptions options;
  std::string rate = "1";
};

Duration from_seconds(double seconds) {
  return Duration{static_cast<Duration::rep>(seconds * 1e9)};
}

void add_seconds(CLI::App& app, const std::string& name, const std::string& text,
                 const std::function<void(Duration)>& take) {
  app.add_option_function<double>(
         name, [take](double seconds) { take(from_seconds(seconds)); }, text)
      ->check(CLI::Range(0.0, kLongest))
      ->type_name("SECONDS");
}

void add_probability(CLI::App& app, const std::string& name, const std::string& text,
                     double& value) {
  app.add_option(name, value, text)->check(CLI::Range(0.0, 1.0))->type_name("P");
}

void add_destinations(CLI::App& app, ReplayOptions& options) {
  app.add_option("--to-address", options.to_address,
                 "Where the lidar's packets go: a host, a broadcast or a group (default 127.0.0.1)")
      ->type_name("ADDRESS");
  app.add_option("--port", options.data_port, "UDP port of data packets (default lidar.data_port)")
      ->check(CLI::Range(1, 65535))
      ->type_name("PORT");
  app.add_option("--position-port", options.position_port,
                 "UDP port of position packets (default lidar.position_port)")
      ->check(CLI::Range(1, 65535))
      ->type_name("PORT");
  app.add_option("--imu-link", options.imu_link,
                 "Symbolic link to make to the terminal that is the IMU")
      ->type_name("PATH");
  app.add_option("--can-interface", options.can_interface,
                 "CAN interface that the frames go to (default vcan0)")
      ->default_val("vcan0")
      ->type_name("INTERFACE");
}

void add_playing(CLI::App& app, ReplayArguments& args) {
  PlayerOptions& player = args.options.player;
  app.add_option("--rate", args.rate, "Recorded seconds per second, or max (default 1)")
      ->type_name("X|max");
  CLI::Option* times = app.add_option("--times", player.times, "Play it so many times (default 1)")
                           ->check(CLI::Range(1, 1'000'000'000))
                           ->type_name("N");
  app.add_flag_callback(
         "--loop", [&player] { player.times = 0; }, "Again and again, until a signal")
      ->excludes(times);
  add_seconds(app, "--from", "Begin here, after the first record",
              [&player](Duration span) { player.from = span; });
  add_seconds(app, "--to", "End here, after the first record",
              [&player](Duration span) { player.to = span; });
  add_seconds(app, "--wait", "Start when a program has opened the IMU, or after this time",
              [&player](Duration span) { player.wait = span; });
}

void add_faults(CLI::App& app, ReplayOptions& options) {
  Faults& faults = options.player.faults;
  PlayerOptions& player = options.player;
  const std::string group = "Faults";
  CLI::App* faulty = app.add_option_group(group);
  add_probability(*faulty, "--loss", "Share of packets, messages and frames that are lost",
                  faults.loss);
  add_probability(*faulty, "--duplicate", "Share of lidar packets that come twice",
                  faults.duplicate);
  add_probability(*faulty, "--reorder", "Share of lidar packets that come after the next one",
                  faults.reorder);
  add_probability(*faulty, "--garbage", "How often noise follows a lidar packet or IMU message",
                  faults.garbage);
  faulty
      ->add_option_function<double>(
          "--delay", [&faults](double ms) { faults.delay = from_seconds(ms * 1e-3); },
          "Lidar packets come up to this much late, in order")
      ->check(CLI::Range(0.0, 1e6))
      ->type_name("MS");
  add_seconds(*faulty, "--stall", "All sensors are silent for this long, again and again",
              [&faults](Duration span) { faults.stall = span; });
  add_seconds(*faulty, "--stall-every", "Time from one stall to the next (default 10)",
              [&faults](Duration span) { faults.stall_every = span; });
  add_seconds(*faulty, "--unplug-imu", "Pull the IMU's plug after this time",
              [&player](Duration span) { player.unplug_imu = span; });
  add_seconds(*faulty, "--unplugged-for", "Until it is plugged in again (default 2)",
              [&player](Duration span) { player.unplugged_for = span; });
  faulty->add_option("--seed", options.seed, "Of what goes wrong when (default 1)")->type_name("N");
}

int run_replay(ReplayArguments& args) {
  ReplayOptions& options = args.options;
  options.recordings = args.recordings.paths;
  options.config = args.config.load();
  options.player.rate = command_line::parse_rate(args.rate);
  const daemon::RecordingPaths& paths = options.recordings;
  if (paths.lidar.empty() && paths.imu.empty() && paths.can.empty()) {
    throw command_line::UsageError("expected a recording: --lidar, --imu or --can");
  }
  if (options.player.from >= options.player.to) {
    throw command_line::UsageError("--from: expected a time before --to");
  }
  if (options.player.faults.stall > options.player.faults.stall_every) {
    throw command_line::UsageError("--stall: expected at most the time of --stall-every");
  }
  replay(options);
  return command_line::kDone;
}

}  // namespace

Command add_replay(CLI::App& root) {
  CLI::App* app =
      root.add_subcommand("replay", "Feed a running daemon with a recording as the sensors would");
  const auto args = std::make_shared<ReplayArguments>();
  args->options.player.faults.stall_every = std::chrono::seconds{10};
  args->recordings.add_to(*app, false);
  args->config.add_to(*app);
  add_destinations(*app, args->options);
  add_playing(*app, *args);
  add_faults(*app, args->options);
  app->add_flag("--json", args->options.json, "Print the summary as one JSON object");
  app->footer(
      "The times and counters inside the packets go on as a sensor's would, also with --loop and\n"
      "--rate. The IMU is a terminal that answers like an MTi.\n"
      "Example:\n"
      "  convexcut replay --lidar lidar.pcap --imu imu.pcap --imu-link /tmp/imu --loop &\n"
      "  convexcutd --set imu.device=/tmp/imu");
  return {app, [args] { return run_replay(*args); }};
}

}  // namespace convexcut::replay
