// SPDX-License-Identifier: Apache-2.0
#include "replay/evaluation/evaluation.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "replay/text.hpp"

namespace convexcut::evaluation {
namespace {

// How far the result's clock may be from the truth's.
constexpr Duration kClockError = std::chrono::milliseconds{100};

}  // namespace

Evaluator::Evaluator(const EvaluateOptions& options)
    : options_(options), truth_(options.truth), result_(options.result), matcher_(truth_) {
  check_times();
}

// Two recordings of different times are told apart without reading a scan.
void Evaluator::check_times() const {
  const simulation::TruthSettings& settings = truth_.settings();
  const HostTime from = settings.start - kClockError;
  const HostTime to = settings.start + settings.length + kClockError;
  for (const ResultScan& scan : result_.scans()) {
    if (scan.stamp >= from && scan.stamp <= to) continue;
    throw std::runtime_error("truth and result do not belong together: scan " +
                             std::to_string(scan.index) + " of " + options_.result.string() +
                             " is of " + replay::utc(scan.stamp) + ", but " +
                             options_.truth.string() + " is of " + replay::utc(settings.start) +
                             " to " + replay::utc(settings.start + settings.length));
  }
}

// What a damaged file could hold would not fit into the tables of surfaces.
void Evaluator::check_surfaces(const MatchedTruth& truth) const {
  const std::size_t surfaces = truth_.settings().surfaces.size();
  for (std::size_t i = 0; i < truth.label.size(); ++i) {
    if (truth.label[i] == simulation::SurfaceLabel::none) continue;
    if (truth.label[i] <= simulation::SurfaceLabel::dynamic && truth.surface[i] < surfaces)
      continue;
    throw std::runtime_error(options_.truth.string() + ": damaged: a return is of surface " +
                             std::to_string(truth.surface[i]) + ", expected less than the " +
                             std::to_string(surfaces) + " of the scene");
  }
}

void Evaluator::load(const ResultScan& scan, MatchedScan& out) {
  out.cloud = result_.read(scan);
  if (matcher_.match(scan.stamp, out.cloud, out.truth)) return check_surfaces(out.truth);
  throw std::runtime_error("truth and result do not belong together: the ranges of scan " +
                           std::to_string(scan.index) + " of " + options_.result.string() +
                           " are not those of " + options_.truth.string() +
                           " at its time; expected the result of the recording beside that truth");
}

Evaluation Evaluator::run(Progress progress) {
  Evaluation all;
  all.settings = truth_.settings();
  MatchedScan matched;
  std::size_t done = 0;
  for (const ResultScan& scan : result_.scans()) {
    progress(done++, result_.scans().size());
    if (scan.coverage < options_.least_coverage || scan.points == 0) {
      ++all.left_out;
      continue;
    }
    load(scan, matched);
    const auto& [cloud, truth] = matched;
    EvaluatedScan evaluated{scan, {}, truth.unmatched, truth.offset};
    evaluated.figures.points = count_points(cloud.label, truth.label);
    judge_.set_input(cloud.view(), truth.label);
    evaluated.figures.patches = judge_.judge(cloud.label);
    add_surfaces(cloud.label, truth.label, truth.surface, all.by_surface);
    all.totals.add(evaluated.figures);
    all.unmatched += truth.unmatched;
    all.scans.push_back(evaluated);
  }
  if (all.scans.empty()) {
    throw std::runtime_error(
        options_.result.string() + ": nothing to evaluate: none of its " +
        std::to_string(all.left_out) + " scans has points and a coverage of at least " +
        replay::format("%.2f", options_.least_coverage) + " (--least-coverage)");
  }
  all.by_surface.resize(std::max(all.by_surface.size(), all.settings.surfaces.size()));
  return all;
}

}  // namespace convexcut::evaluation
