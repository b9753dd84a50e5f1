// SPDX-License-Identifier: Apache-2.0
#include "replay/evaluation/report.hpp"

#include <algorithm>
#include <functional>

#include "replay/simulation/truth/label_name.hpp"
#include "replay/text.hpp"

namespace convexcut::evaluation {
namespace {

using replay::format;
using replay::JsonObject;

constexpr std::size_t kMostSurfaces = 10;  // in the table

[[nodiscard]] unsigned long long number(std::uint64_t value) { return value; }

[[nodiscard]] std::string row(const EvaluatedScan& scan) {
  const Score points = scan.figures.point_score();
  const Score patches = scan.figures.patch_score();
  const PatchCounts& counts = scan.figures.patches;
  return format("%6llu %8zu %6.3f %6.3f %6.3f %6.3f %5llu %4llu %4llu %4llu %6.3f %6.3f %6.3f\n",
                number(scan.scan.index), scan.scan.points, points.precision, points.recall,
                points.f, dynamic_ratio(scan.figures.points), number(counts.objects_removed),
                number(counts.objects_kept), number(counts.structure_kept),
                number(counts.structure_lost), patches.precision, patches.recall, patches.f);
}

[[nodiscard]] std::string worst_text(const Evaluation& evaluation, const Summary& summary) {
  return format("%.3f (scan %llu)", summary.worst(),
                number(evaluation.scans[summary.worst_at()].scan.index));
}

[[nodiscard]] std::string score_rows(const Evaluation& evaluation, const char* of,
                                     const ScoreSummary& scores) {
  std::string text;
  for (const auto& [name, summary] :
       {std::pair{"precision", &scores.precision}, {"recall", &scores.recall}, {"F", &scores.f}}) {
    text += format("%-8s %-10s %s   worst %s\n", of, name, mean_text(*summary).c_str(),
                   worst_text(evaluation, *summary).c_str());
  }
  return text;
}

[[nodiscard]] std::string surface_rows(const Evaluation& evaluation) {
  std::string text;
  std::size_t shown = 0;
  for (const std::size_t surface : surfaces_by_errors(evaluation)) {
    if (++shown > kMostSurfaces) break;
    const SurfaceCounts& counts = evaluation.by_surface[surface];
    text += format("%-28s %-9s %10s %10s %6.1f %%\n", surface_name(evaluation, surface).c_str(),
                   std::string(simulation::name_in(simulation::kLabelNames,
                                                   evaluation.settings.surfaces[surface].label))
                       .c_str(),
                   replay::grouped(counts.points).c_str(), replay::grouped(counts.wrong).c_str(),
                   100.0 * static_cast<double>(counts.wrong) / static_cast<double>(counts.points));
  }
  if (text.empty()) return text;
  return format("\n%-28s %-9s %10s %10s %8s\n", "surface", "truly", "points", "wrong", "share") +
         text;
}

[[nodiscard]] JsonObject json_of(const Score& score) {
  JsonObject object;
  object.add("precision", score.precision, 6).add("recall", score.recall, 6).add("f", score.f, 6);
  return object;
}

[[nodiscard]] JsonObject json_of(const Evaluation& evaluation, const Summary& summary) {
  JsonObject object;
  object.add("mean", summary.mean(), 6)
      .add("standard_deviation", summary.standard_deviation(), 6)
      .add("worst", summary.worst(), 6)
      .add("worst_scan", evaluation.scans[summary.worst_at()].scan.index);
  return object;
}

[[nodiscard]] JsonObject json_of(const Evaluation& evaluation, const ScoreSummary& scores) {
  JsonObject object;
  object.add("precision", json_of(evaluation, scores.precision))
      .add("recall", json_of(evaluation, scores.recall))
      .add("f", json_of(evaluation, scores.f));
  return object;
}

[[nodiscard]] JsonObject json_of(const PointCounts& counts) {
  JsonObject object = json_of(score_of(counts));
  object.add("true_positive", counts.true_positive)
      .add("false_positive", counts.false_positive)
      .add("false_negative", counts.false_negative)
      .add("true_negative", counts.true_negative)
      .add("dynamic", counts.dynamic)
      .add("unjudged", counts.unjudged)
      .add("unjudged_kept", counts.unjudged_kept);
  return object;
}

[[nodiscard]] JsonObject json_of(const PatchCounts& counts) {
  JsonObject object = json_of(score_of(counts));
  object.add("objects_removed", counts.objects_removed)
      .add("objects_kept", counts.objects_kept)
      .add("structure_kept", counts.structure_kept)
      .add("structure_lost", counts.structure_lost)
      .add("object_fragments", counts.object_fragments);
  return object;
}

[[nodiscard]] std::vector<JsonObject> json_of_scans(const Evaluation& evaluation) {
  std::vector<JsonObject> scans;
  for (const EvaluatedScan& scan : evaluation.scans) {
    scans.emplace_back()
        .add("index", scan.scan.index)
        .add("points", json_of(scan.figures.points))
        .add("patches", json_of(scan.figures.patches))
        .add("dynamic_ratio", dynamic_ratio(scan.figures.points), 6)
        .add("unmatched_points", std::uint64_t{scan.unmatched})
        .add("clock_offset_us", static_cast<double>(scan.offset.count()) * 1e-3, 3);
  }
  return scans;
}

[[nodiscard]] std::vector<JsonObject> json_of_surfaces(const Evaluation& evaluation) {
  std::vector<JsonObject> surfaces;
  for (std::size_t i = 0; i < evaluation.by_surface.size(); ++i) {
    const SurfaceCounts& counts = evaluation.by_surface[i];
    if (counts.points == 0) continue;
    surfaces.emplace_back()
        .add("name", surface_name(evaluation, i))
        .add("label",
             simulation::name_in(simulation::kLabelNames, evaluation.settings.surfaces[i].label))
        .add("points", counts.points)
        .add("kept", counts.kept)
        .add("wrong", counts.wrong);
  }
  return surfaces;
}

}  // namespace

std::vector<std::size_t> surfaces_by_errors(const Evaluation& evaluation) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < evaluation.by_surface.size(); ++i) {
    if (evaluation.by_surface[i].wrong > 0) order.push_back(i);
  }
  std::ranges::stable_sort(order, std::ranges::greater{},
                           [&](std::size_t i) { return evaluation.by_surface[i].wrong; });
  return order;
}

std::string surface_name(const Evaluation& evaluation, std::size_t surface) {
  const auto& surfaces = evaluation.settings.surfaces;
  return surface < surfaces.size() ? surfaces[surface].name : "surface " + std::to_string(surface);
}

std::string mean_text(const Summary& summary) {
  return format("%.3f ± %.3f", summary.mean(), summary.standard_deviation());
}

std::string report_table(const Evaluation& evaluation, bool each_scan) {
  std::string text;
  if (each_scan) {
    text += "                         points                     patches\n";
    text +=
        "  scan   points      P      R      F    dyn     A    B    C    D      P      R      F\n";
    for (const EvaluatedScan& scan : evaluation.scans) text += row(scan);
    text += "\n";
  }
  text += format("scene    %s, seed %llu\n", evaluation.settings.scene.c_str(),
                 number(evaluation.settings.seed));
  text += format("scans    %zu", evaluation.scans.size());
  if (evaluation.left_out > 0) text += format(", %zu left out (not whole)", evaluation.left_out);
  text += format("\ndynamic  %s of the points\n",
                 mean_text(evaluation.totals.dynamic_ratios()).c_str());
  text += score_rows(evaluation, "points", evaluation.totals.points());
  text += score_rows(evaluation, "patches", evaluation.totals.patches());
  return text + surface_rows(evaluation);
}

std::string report_json(const Evaluation& evaluation) {
  const Totals& totals = evaluation.totals;
  JsonObject object;
  object.add("scene", evaluation.settings.scene)
      .add("seed", evaluation.settings.seed)
      .add("scans_evaluated", std::uint64_t{evaluation.scans.size()})
      .add("scans_left_out", std::uint64_t{evaluation.left_out})
      .add("unmatched_points", std::uint64_t{evaluation.unmatched})
      .add("points", json_of(evaluation, totals.points()))
      .add("patches", json_of(evaluation, totals.patches()))
      .add("dynamic_ratio", json_of(evaluation, totals.dynamic_ratios()))
      .add("points_pooled", json_of(totals.pooled().points))
      .add("patches_pooled", json_of(totals.pooled().patches))
      .add("surfaces", json_of_surfaces(evaluation))
      .add("scans", json_of_scans(evaluation));
  return object.text();
}

}  // namespace convexcut::evaluation
