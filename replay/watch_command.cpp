// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <memory>

#include "daemon/command_line/arguments.hpp"
#include "replay/commands.hpp"
#include "replay/watch.hpp"

namespace convexcut::replay {
namespace {

struct WatchArguments {
  command_line::ConfigArguments config;
  std::optional<std::uint32_t> domain;
  std::optional<std::int64_t> seconds;
  bool json = false;
};

int run_watch(const WatchArguments& args) {
  WatchOptions options;
  options.dds = args.config.load().dds;
  if (args.domain) options.dds.domain = *args.domain;
  if (args.seconds) options.duration = std::chrono::seconds{*args.seconds};
  options.json = args.json;
  return watch(options, stdout);
}

}  // namespace

Command add_watch(CLI::App& root) {
  CLI::App* app = root.add_subcommand(
      "watch",
      "Listen to a daemon's topics: rate, points, structure, latency and losses every second");
  const auto args = std::make_shared<WatchArguments>();
  args->config.add_to(*app);
  app->add_option("--domain", args->domain, "DDS domain, as dds.domain (default 0)")
      ->check(CLI::Range(0U, 232U))
      ->type_name("N");
  app->add_option("--seconds", args->seconds, "Stop after this time (default: at Ctrl-C)")
      ->check(CLI::Range(1, 1'000'000))
      ->type_name("N");
  app->add_flag("--json", args->json, "Print one JSON object a second");
  app->footer(
      "Examples:\n"
      "  convexcut watch\n"
      "  convexcut watch --domain 7 --seconds 10 --json");
  return {app, [args] { return run_watch(*args); }};
}

}  // namespace convexcut::replay
