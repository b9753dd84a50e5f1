// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>

#include "daemon/command_line/arguments.hpp"
#include "replay/commands.hpp"
#include "replay/pcd_reader.hpp"
#include "replay/picture.hpp"

namespace convexcut::replay {
namespace {

struct PictureArguments {
  std::filesystem::path scan;
  std::filesystem::path out;
  std::string title;
  double slice_deg = 0.0;
};

int run_picture(const PictureArguments& args) {
  const PcdCloud cloud = read_pcd(args.scan);
  PictureInput input;
  input.cloud = cloud.view();
  input.label = cloud.label;
  input.title = args.title.empty() ? args.scan.filename().string() : args.title;
  input.slice_angle = Degrees{args.slice_deg};
  render_picture(input, args.out);
  std::printf("%s\n", args.out.c_str());
  return command_line::kDone;
}

}  // namespace

Command add_picture(CLI::App& root) {
  CLI::App* app = root.add_subcommand(
      "picture", "Draw a labelled scan: from above, and one vertical slice with its hull");
  const auto args = std::make_shared<PictureArguments>();
  app->add_option("scan", args->scan, "A scan written by convexcut process, or any PCD file")
      ->type_name("FILE.pcd")
      ->required();
  app->add_option("--out", args->out, "The picture")->type_name("FILE.png")->required();
  app->add_option("--slice-deg", args->slice_deg,
                  "Direction of the slice from x towards y (default 0)")
      ->check(CLI::Range(-360.0, 360.0))
      ->type_name("DEGREES");
  app->add_option("--title", args->title, "Title (default: the file's name)")->type_name("TEXT");
  app->footer("Example:\n  convexcut picture scans/scan_000003.pcd --out scan.png --slice-deg 45");
  return {app, [args] { return run_picture(*args); }};
}

}  // namespace convexcut::replay
