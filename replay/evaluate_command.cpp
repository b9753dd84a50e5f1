// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>

#include "daemon/command_line/arguments.hpp"
#include "replay/atomic_file.hpp"
#include "replay/commands.hpp"
#include "replay/evaluation/error_map.hpp"
#include "replay/evaluation/evaluation.hpp"
#include "replay/evaluation/report.hpp"
#include "replay/evaluation/report_html.hpp"
#include "replay/progress_bar.hpp"

namespace convexcut::replay {
namespace {

struct EvaluateArguments {
  evaluation::EvaluateOptions options;
  std::filesystem::path json;
  std::filesystem::path html;
  std::string title;
  bool quiet = false;
};

void write_file(const std::filesystem::path& file, const std::string& text) {
  AtomicFile out(file);
  out.write(text);
  out.commit();
}

std::string html_of(const EvaluateArguments& args, evaluation::Evaluator& evaluator,
                    const evaluation::Evaluation& result) {
  std::vector<evaluation::ErrorMap> maps;
  evaluation::MatchedScan matched;
  for (const std::size_t scan : evaluation::scans_to_show(result)) {
    evaluator.load(result.scans[scan].scan, matched);
    maps.push_back({scan, evaluation::error_map_png(
                              {matched.cloud.view(), matched.cloud.label, matched.truth.label})});
  }
  const std::string title =
      args.title.empty() ? "Evaluation of " + args.options.result.string() : args.title;
  return evaluation::report_html(result, title, maps);
}

int run_evaluate(const EvaluateArguments& args) {
  evaluation::Evaluator evaluator(args.options);
  evaluation::Evaluation result;
  {
    ProgressBar bar("evaluate");
    result = evaluator.run([&bar](std::size_t done, std::size_t scans) {
      bar.update(done, scans, std::to_string(done) + " of " + std::to_string(scans) + " scans");
    });
  }
  if (!args.json.empty()) write_file(args.json, evaluation::report_json(result) + "\n");
  if (!args.html.empty()) write_file(args.html, html_of(args, evaluator, result));
  std::fputs(evaluation::report_table(result, !args.quiet).c_str(), stdout);
  if (result.unmatched > 0) {
    std::fprintf(stderr, "warning: the truth of %zu points was not found; they are in no figure\n",
                 result.unmatched);
  }
  return command_line::kDone;
}

}  // namespace

Command add_evaluate(CLI::App& root) {
  CLI::App* app = root.add_subcommand(
      "evaluate",
      "Compare the result of convexcut process with the truth of a simulated recording");
  const auto args = std::make_shared<EvaluateArguments>();
  app->add_option("--truth", args->options.truth, "The folder that convexcut simulate wrote")
      ->type_name("DIR")
      ->required();
  app->add_option("--result", args->options.result,
                  "The folder that convexcut process wrote (--format pcd)")
      ->type_name("DIR")
      ->required();
  app->add_option("--json", args->json, "Write all figures as one JSON object")->type_name("FILE");
  app->add_option("--html", args->html, "Write a report with plots and error maps, in one file")
      ->type_name("FILE");
  app->add_option("--title", args->title, "Title of the report")->type_name("TEXT");
  app->add_option("--least-coverage", args->options.least_coverage,
                  "Leave out scans with less of a revolution (default 0.9)")
      ->check(CLI::Range(0.0, 1.0))
      ->type_name("SHARE");
  app->add_flag("--quiet", args->quiet, "Do not print a line for each scan");
  app->footer(
      "Points are in no figure where the truth is none (ghosts, mixed pixels); docs/evaluate.md "
      "defines all others.\n"
      "Examples:\n"
      "  convexcut simulate --scene office --seconds 10 --seed 1 --out office\n"
      "  convexcut process --lidar office/lidar.pcap --imu office/imu.pcap --out scans\n"
      "  convexcut evaluate --truth office --result scans --html report.html");
  return {app, [args] { return run_evaluate(*args); }};
}

}  // namespace convexcut::replay
