// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/command_line/arguments.hpp"
#include "replay/commands.hpp"
#include "replay/simulate.hpp"

namespace convexcut::replay {
namespace {

using simulation::PathEnd;

// Where the rig goes, when the scene's plan is not wanted.
struct Way {
  std::string points;
  bool travels = false;
  std::optional<double> speed_m_s;
  std::optional<PathEnd> end;
};

struct SimulateArguments {
  SimulateOptions options;
  double seconds = 10.0;
  Way way;
  bool without_pps = false;
  double lidar_ppm = 0.0;
  double imu_error_scale = 1.0;
};

// "1,2;3,4,1.5": way points in metres; z is that of the scene's rig where it is not given.
std::vector<Vec3> way_points(std::string_view text, double z) {
  std::vector<Vec3> points;
  const auto wrong = [&] {
    return command_line::UsageError(
        "--path: expected way points like \"1,2;3,4;3,6,1.5\" that "
        "differ, found \"" +
        std::string(text) + "\"");
  };
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(';', at), text.size());
    const std::string_view point = text.substr(at, end - at);
    at = end + 1;
    std::array<double, 3> values{0.0, 0.0, z};
    std::size_t count = 0;
    const char* from = point.data();
    const char* const to = from + point.size();
    while (true) {
      if (count == values.size()) throw wrong();
      const auto [next, error] = std::from_chars(from, to, values[count++]);
      if (error != std::errc{}) throw wrong();
      if (next == to) break;
      if (*next != ',') throw wrong();
      from = next + 1;
    }
    const Vec3 p(values[0], values[1], values[2]);
    if (count < 2 || !p.allFinite() || (!points.empty() && points.back() == p)) throw wrong();
    points.push_back(p);
  }
  return points;
}

void place_rig(const Way& way, const simulation::Scene& scene, simulation::RigOptions& rig) {
  const simulation::Path& plan = scene.rig().path;
  if (way.travels && way.points.empty() && plan.empty()) {
    throw command_line::UsageError("--travel: the scene " + scene.name() +
                                   " has no path of the rig; expected --path");
  }
  const simulation::RigOptions planned = simulation::planned_rig(scene, way.travels);
  rig.yaw = planned.yaw;
  rig.path = planned.path;
  const bool own = !way.points.empty();
  if (!own && !way.travels) return;
  if (!own && !way.speed_m_s && !way.end) return;
  const std::vector<Vec3> points =
      own ? way_points(way.points, scene.rig().position.z()) : plan.way_points();
  const PathEnd end = way.end.value_or(own || plan.empty() ? PathEnd::back : plan.end());
  rig.path = simulation::RigPath(points, way.speed_m_s.value_or(own ? 0.8 : plan.speed_m_s()), end);
}

std::string scene_names() {
  std::string names;
  for (const std::string_view name : simulation::Scene::names()) {
    names.append(names.empty() ? "" : ", ").append(name);
  }
  return names;
}

void add_run_options(CLI::App& app, SimulateArguments& a) {
  SimulateOptions& o = a.options;
  app.add_option("--scene", o.scene, "A shipped scene (" + scene_names() + ") or a scene file")
      ->type_name("NAME|FILE")
      ->required();
  app.add_option("--out", o.out, "A new folder for the recording and its truth")
      ->type_name("DIR")
      ->required();
  app.add_option("--seconds", a.seconds, "Length of the recording")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  app.add_option("--seed", o.simulation.seed, "Of all that is drawn by chance")
      ->capture_default_str();
  app.add_option("--people", o.scene_options.people, "How many people walk about")
      ->check(CLI::NonNegativeNumber)
      ->type_name("N");
  app.add_option("--picture", o.picture, "Draw one revolution")->type_name("FILE.png");
  app.add_flag("--json", o.json, "Print the summary as one JSON object");
}

void add_rig_options(CLI::App& app, SimulateArguments& a) {
  simulation::RigOptions& rig = a.options.simulation.rig;
  const std::string group = "Rig";
  const auto degrees = [&](const char* name, Degrees& value, double most, const char* what) {
    app.add_option(name, value.value, what)
        ->check(CLI::Range(-most, most))
        ->type_name("DEGREES")
        ->capture_default_str()
        ->group(group);
  };
  degrees("--tilt-deg", rig.tilt, 90.0, "Lean of the lidar about its y axis");
  degrees("--tilt-swing-deg", rig.tilt_swing, 90.0, "The lean swings so far to both sides");
  app.add_option("--tilt-swing-hz", rig.tilt_swing_hz, "How often it swings")
      ->check(CLI::Range(0.0, 5.0))
      ->capture_default_str()
      ->group(group);
  app.add_option("--rotation-dps", rig.rotation_per_second.value,
                 "Turn of the stage about the vertical, degrees a second")
      ->check(CLI::Range(-720.0, 720.0))
      ->capture_default_str()
      ->group(group);
  app.add_option("--sway", rig.sway.value,
                 "A hand holds it: root mean square of roll, pitch and yaw, with 5 mm a degree of "
                 "x, y and z")
      ->check(CLI::Range(0.0, 20.0))
      ->type_name("DEGREES")
      ->capture_default_str()
      ->group(group);
  app.add_flag("--travel", a.way.travels, "Move along the scene's own path")->group(group);
  app.add_option("--path", a.way.points, "Move along this one: way points like \"1,2;3,4;3,6,1.5\"")
      ->type_name("X,Y[,Z];…")
      ->group(group);
  app.add_option("--speed-m-s", a.way.speed_m_s, "Speed on the path (default: the scene's, or 0.8)")
      ->check(CLI::Range(0.01, 10.0))
      ->group(group);
  app.add_option("--path-end", a.way.end, "What follows its last point: back (default), loop, stop")
      ->transform(CLI::CheckedTransformer(std::map<std::string, PathEnd>{
          {"back", PathEnd::back}, {"loop", PathEnd::loop}, {"stop", PathEnd::stop}}))
      ->option_text("back|loop|stop")
      ->group(group);
}

void add_lidar_options(CLI::App& app, SimulateArguments& a) {
  simulation::LidarOptions& lidar = a.options.simulation.lidar;
  simulation::LidarLinkOptions& link = a.options.simulation.link;
  const std::string group = "Lidar";
  const auto number = [&](const char* name, double& value, double low, double high,
                          const char* what) {
    app.add_option(name, value, what)
        ->check(CLI::Range(low, high))
        ->capture_default_str()
        ->group(group);
  };
  number("--rotor-hz", lidar.rotor_hz, 5.0, 20.0, "Revolutions a second");
  number("--noise-m", lidar.noise_m, 0.0, 1.0, "Standard deviation of a range, metres");
  number("--divergence-rad", lidar.divergence.value, 0.0, 0.05, "Of a beam; 0: a line");
  number("--dropout", lidar.dropout, 0.0, 1.0,
         "Share of the shots that are lost, whatever they meet");
  number("--ghosts", lidar.ghosts, 0.0, 1.0, "Share of the returns that are where nothing is");
  app.add_flag("--dual", lidar.dual, "Strongest and last return")->group(group);
  number("--loss", link.loss, 0.0, 1.0, "Share of the packets that never arrive");
  number("--duplicate", link.duplicate, 0.0, 1.0, "Share of the packets that arrive twice");
  number("--reorder", link.reorder, 0.0, 1.0, "Share of the packets that the next one overtakes");
  number("--lidar-ppm", a.lidar_ppm, -200.0, 200.0,
         "By how much the lidar's clock runs fast; without PPS only");
  app.add_flag("--no-pps", a.without_pps, "The lidar has no GPS: its counter is not UTC")
      ->group(group);
}

void add_imu_options(CLI::App& app, SimulateArguments& a) {
  simulation::SimulationOptions& o = a.options.simulation;
  const std::string group = "IMU";
  app.add_option("--gravity-error-deg", o.imu_errors.gravity.value,
                 "What it takes for the vertical is so far off, always to one side of the room")
      ->check(CLI::Range(0.0, 45.0))
      ->capture_default_str()
      ->group(group);
  app.add_option("--imu-errors", a.imu_error_scale,
                 "Its other errors, as multiples of an MTi-30's; 0: ideal")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str()
      ->group(group);
  app.add_option("--imu-ppm", o.serial_imu.clock.fast_by_ppm, "By how much its clock runs fast")
      ->check(CLI::Range(-200.0, 200.0))
      ->capture_default_str()
      ->group(group);
}

void scale(simulation::ImuNoise& noise, double by) {
  noise.rate_of_turn_rad_s *= by;
  noise.acceleration_m_s2 *= by;
}

int run_simulate(SimulateArguments a) {
  simulation::SimulationOptions& o = a.options.simulation;
  o.length = std::chrono::round<Duration>(std::chrono::duration<double>(a.seconds));
  o.rig.sway_m = 0.005 * o.rig.sway.value;
  if (!a.without_pps && a.lidar_ppm != 0.0) {
    throw command_line::UsageError("--lidar-ppm: a lidar with PPS follows UTC; expected --no-pps");
  }
  if (a.without_pps) o.link.pps = PpsState::absent;
  o.lidar.clock.fast_by_ppm = a.lidar_ppm;
  simulation::ImuErrors& errors = o.imu_errors;
  for (double* error : {&errors.tilt.value, &errors.wander.value, &errors.rate_bias_rad_s,
                        &errors.acceleration_bias_m_s2}) {
    *error *= a.imu_error_scale;
  }
  scale(o.serial_imu.noise, a.imu_error_scale);
  scale(o.can_imu.noise, a.imu_error_scale);
  a.options.place_rig = [&a](const simulation::Scene& scene, simulation::RigOptions& rig) {
    place_rig(a.way, scene, rig);
  };
  simulate(a.options);
  return command_line::kDone;
}

}  // namespace

Command add_simulate(CLI::App& root) {
  CLI::App* app = root.add_subcommand(
      "simulate", "Write what a lidar and an IMU would record in a scene, and the truth about it");
  const auto args = std::make_shared<SimulateArguments>();
  add_run_options(*app, *args);
  add_rig_options(*app, *args);
  add_lidar_options(*app, *args);
  add_imu_options(*app, *args);
  app->footer(
      "Examples:\n"
      "  convexcut simulate --scene office --out office --picture office.png\n"
      "  convexcut simulate --scene glass-offices --travel --sway 2 --seconds 60 --out drive\n"
      "  convexcut process --config office/convexcut.toml --lidar office/lidar.pcap --imu "
      "office/imu.pcap --out scans");
  return {app, [args] { return run_simulate(*args); }};
}

}  // namespace convexcut::replay
