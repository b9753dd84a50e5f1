// SPDX-License-Identifier: Apache-2.0
//
// convexcut-demo-room: makes a recording of a room that does not exist, for trials without sensors.
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

#include "apps/demo_room/recording.hpp"
#include "daemon/command_line/arguments.hpp"
#include "replay/progress_bar.hpp"

namespace convexcut::sim {
namespace {

struct Arguments {
  std::filesystem::path out;
  double seconds = 5.0;
  bool empty = false;
  bool without_pps = false;
  RecordingOptions options;
};

constexpr const char* kAbout =
    "Writes lidar.pcap (HDL-32E), imu.pcap (MTi on a serial line) and can.log (MTi-600 on CAN) of "
    "a\n"
    "furnished room with two people walking, seen from a rig that turns and sways. The same\n"
    "arguments give the same bytes.";
constexpr const char* kExample =
    "Example:\n"
    "  convexcut-demo-room --out demo --seconds 10\n"
    "  convexcut process --lidar demo/lidar.pcap --imu demo/imu.pcap --out scans";

void add_options(CLI::App& app, Arguments& a) {
  RecordingOptions& o = a.options;
  app.add_option("--out", a.out, "Folder to write to; made when it is not there")->required();
  app.add_option("--seconds", a.seconds, "Length of the recording")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  app.add_option("--seed", o.seed, "Of the noise")->capture_default_str();
  app.add_option("--tilt-deg", o.motion.tilt.value, "Farthest lean of the rig")
      ->check(CLI::Range(0.0, 45.0))
      ->capture_default_str();
  app.add_option("--turn-deg-s", o.motion.turn_per_second.value,
                 "Turn of the rig about the vertical")
      ->check(CLI::Range(-180.0, 180.0))
      ->capture_default_str();
  app.add_option("--rate-hz", o.lidar.rotor_hz, "Revolutions of the lidar a second")
      ->check(CLI::Range(5.0, 20.0))
      ->capture_default_str();
  app.add_option("--noise-m", o.lidar.noise_m, "Standard deviation of a range, metres")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--dropout", o.lidar.dropout, "Share of the returns that are lost")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--imu-rate-hz", o.serial_imu.rate_hz, "Samples of the serial IMU a second")
      ->check(CLI::IsMember({10, 20, 25, 40, 50, 80, 100, 200, 400}))
      ->capture_default_str();
  app.add_option("--imu-baud", o.serial_imu.baud, "Bits a second on the IMU's serial line")
      ->check(CLI::IsMember({9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600}))
      ->capture_default_str();
  app.add_flag("--no-pps", a.without_pps, "The lidar has no GPS: its counter is not UTC");
  app.add_flag("--empty", a.empty, "No pillar, no furniture, nobody");
  app.footer(kExample);
}

void check_together(const simulation::SerialImuOptions& imu) {
  const std::int64_t most = simulation::max_rate_hz(imu.baud);
  if (imu.rate_hz <= most) return;
  throw command_line::UsageError("--imu-rate-hz: " + std::to_string(imu.baud) +
                                 " baud carry at most " + std::to_string(most) +
                                 " samples a second, found " + std::to_string(imu.rate_hz));
}

int run(Arguments& a) {
  check_together(a.options.serial_imu);
  a.options.length = std::chrono::round<Duration>(std::chrono::duration<double>(a.seconds));
  if (a.empty) a.options.furnishing = Furnishing::empty;
  if (a.without_pps) a.options.pps = PpsState::absent;
  replay::ProgressBar bar("simulating");
  write_recording(a.options, a.out,
                  [&](std::uint64_t done, std::uint64_t total) { bar.update(done, total); });
  return command_line::kDone;
}

}  // namespace
}  // namespace convexcut::sim

// What could escape is a mistake in the definition of the options: then it may end the program.
// NOLINTNEXTLINE(bugprone-exception-escape)
int main(int argc, char** argv) {
  using namespace convexcut;
  CLI::App root(sim::kAbout, "convexcut-demo-room");
  sim::Arguments arguments;
  sim::add_options(root, arguments);
  return command_line::run_program(root, argc, argv, [&] { return sim::run(arguments); });
}
