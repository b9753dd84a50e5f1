// SPDX-License-Identifier: Apache-2.0
#include "daemon/command_line/arguments.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>

#include "config/choices.hpp"
#include "config/loader.hpp"
#include "core/simd/simd_path.hpp"

namespace convexcut::command_line {
namespace {

// The command that the user meant, for "see … --help".
std::string full_name(const CLI::App& root) {
  const auto chosen = root.get_subcommands();
  return root.get_name() + (chosen.empty() ? "" : " " + chosen.front()->get_name());
}

int fail(const std::string& who, const std::string& what, int status) {
  std::fprintf(stderr, "%s: %s\n", who.c_str(), what.c_str());
  return status;
}

// An option whose value is empty, as an unset variable of a shell leaves it, would say "the file
// without a name" or count as not given. Throws UsageError.
void refuse_empty_values(const CLI::App& app) {
  for (const CLI::Option* const option : app.get_options()) {
    const auto& values = option->results();
    if (std::find(values.begin(), values.end(), "") != values.end()) {
      throw UsageError(option->get_name() + " is empty: expected " + option->get_type_name() +
                       " (a variable that is not set?)");
    }
  }
  for (const CLI::App* const command : app.get_subcommands()) refuse_empty_values(*command);
}

// The kernels of the whole program run with it from here on.
void choose_simd_path(config::SimdPath path) {
  const std::string_view name = config::kNames<config::SimdPath>[static_cast<std::size_t>(path)];
  if (use_simd_path(name)) return;
  std::string expected = "auto";
  for (const std::string_view available : simd_paths()) expected.append(", ").append(available);
  throw UsageError("convex_cut.simd: this processor or build has no " + std::string(name) +
                   ": expected one of " + expected);
}

}  // namespace

void ConfigArguments::add_to(CLI::App& app) {
  app.add_option("--config", file, "Configuration file (TOML); every key has a default")
      ->type_name("FILE");
  app.add_option("--set", overrides, "Override one configuration key, e.g. lidar.min_range_m=0.3")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

config::Config ConfigArguments::load() const {
  config::Config config = config::load(file, overrides);
  choose_simd_path(config.convex_cut.simd);
  return config;
}

void RecordingArguments::add_to(CLI::App& app, bool lidar_required) {
  app.add_option("--lidar", paths.lidar, "Lidar packets: pcap or pcapng")
      ->type_name("FILE")
      ->required(lidar_required);
  app.add_option("--imu", paths.imu, "IMU: pcap of stamped serial reads (USER0) or raw .bin stream")
      ->type_name("FILE");
  app.add_option("--can", paths.can, "CAN: candump -L log or pcap (CAN_SOCKETCAN)")
      ->type_name("FILE");
  app.add_option_function<double>(
         "--imu-start",
         [this](double offset_s) {
           paths.imu_start = Duration{static_cast<Duration::rep>(offset_s * 1e9)};
         },
         "When a raw .bin IMU stream starts, after the first lidar packet (default 0)")
      ->type_name("SECONDS");
}

void RecordingArguments::add_poses_to(CLI::App& app) {
  app.add_option("--poses", paths.poses,
                 "Poses of the lidar for method robust: CSV stamp_ns,x,y,z,qx,qy,qz,qw")
      ->type_name("FILE");
}

int run_program(CLI::App& root, int argc, char** argv, const std::function<int()>& run) {
  try {
    root.parse(argc, argv);
    refuse_empty_values(root);
    return run();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return root.exit(error);  // --help, --version
    return fail(root.get_name(),
                std::string(error.what()) + " (see " + full_name(root) + " --help)", kUsage);
  } catch (const config::ConfigError& error) {
    // One line an error, each of which begins with its place.
    std::fprintf(stderr, "%s\n", error.what());
    return kUsage;
  } catch (const UsageError& error) {
    return fail(full_name(root), error.what(), kUsage);
  } catch (const std::exception& error) {
    return fail(full_name(root), error.what(), kFailed);
  }
}

}  // namespace convexcut::command_line
