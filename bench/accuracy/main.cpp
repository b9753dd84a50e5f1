// SPDX-License-Identifier: Apache-2.0
//
// convexcut_accuracy: paper, robust and three baselines on simulated, labelled scans, as JSON.
// ./accuracy.sh runs it and writes docs/accuracy.md.
#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "bench/accuracy/experiments.hpp"
#include "bench/accuracy/run.hpp"
#include "bench/program.hpp"

namespace convexcut::bench {
namespace {

void print_score(const char* name, const evaluation::ScoreSummary& s, const char* end) {
  std::printf(
      "\"%s\": {\"n\": %zu, \"p\": %.5f, \"p_sd\": %.5f, \"r\": %.5f, \"r_sd\": %.5f, "
      "\"f\": %.5f, \"f_sd\": %.5f, \"worst\": %.5f}%s",
      name, s.f.count(), s.precision.mean(), s.precision.standard_deviation(), s.recall.mean(),
      s.recall.standard_deviation(), s.f.mean(), s.f.standard_deviation(), s.f.worst(), end);
}

void print(const Run& run, const Outcome& o, bool first) {
  std::printf("%s\n{\"experiment\": \"%s\", \"variant\": \"%s\", \"scene\": \"%s\", ",
              first ? "" : ",", run.experiment.c_str(), run.variant.c_str(), run.scene.c_str());
  std::printf(R"("tilt": %.0f, "seed": %llu, "method": "%s", )", run.tilt_deg,
              static_cast<unsigned long long>(run.options.simulation.seed), o.method.c_str());
  print_score("points", o.points, ", ");
  print_score("settled", o.settled, ", ");
  print_score("patches", o.patches, ", ");
  const evaluation::PatchCounts& c = o.pooled_patches;
  std::printf("\"patch_counts\": [%llu, %llu, %llu, %llu], ",
              static_cast<unsigned long long>(c.objects_removed),
              static_cast<unsigned long long>(c.objects_kept),
              static_cast<unsigned long long>(c.structure_kept),
              static_cast<unsigned long long>(c.structure_lost));
  std::printf("\"errors\": {");
  for (const SurfaceErrors& e : o.errors) {
    std::printf("%s\"%s\": [%llu, %llu, %llu]", &e == o.errors.data() ? "" : ", ", e.name.c_str(),
                static_cast<unsigned long long>(e.counts.points),
                static_cast<unsigned long long>(e.counts.kept),
                static_cast<unsigned long long>(e.counts.wrong));
  }
  std::printf(R"(}, "unjudged": %llu, "unjudged_kept": %llu, "dynamic": %.4f, "ms": %.3f})",
              static_cast<unsigned long long>(o.pooled.unjudged),
              static_cast<unsigned long long>(o.pooled.unjudged_kept), o.dynamic_ratio.mean(),
              o.scans == 0 ? 0.0 : o.milliseconds / static_cast<double>(o.scans));
  std::fflush(stdout);
}

void run_all(const std::vector<Experiment>& experiments) {
  std::printf("[");
  bool first = true;
  for (const Experiment& experiment : experiments) {
    for (const Run& run : experiment.runs) {
      std::fprintf(stderr, "%s: %s %s, tilt %.0f, seed %llu\n", run.experiment.c_str(),
                   run.scene.c_str(), run.variant.c_str(), run.tilt_deg,
                   static_cast<unsigned long long>(run.options.simulation.seed));
      for (const Outcome& outcome : outcomes_of(run, experiment.methods)) {
        print(run, outcome, first);
        first = false;
      }
    }
  }
  std::printf("\n]\n");
}

int program(int argc, char** argv) {
  CLI::App app{"Accuracy of paper, robust and baselines on simulated scans; JSON on stdout"};
  ExperimentOptions options;
  app.add_flag("--quick", options.quick, "one seed, few scans, no long recordings");
  app.add_option("--first-seed", options.first_seed, "of three; nothing was tuned on the default");
  app.add_option("--only", options.only, "one experiment by its name");
  app.add_option("--scene", options.scene, "runs in this scene alone");
  app.add_option("--tilt", options.tilt_deg, "runs with this tilt alone, degrees");
  app.add_option("--method", options.method, "this method alone");
  CLI11_PARSE(app, argc, argv);
  run_all(experiments(options));
  return 0;
}

}  // namespace
}  // namespace convexcut::bench

int main(int argc, char** argv) {
  return convexcut::bench::run_program("convexcut_accuracy", convexcut::bench::program, argc, argv);
}
