// SPDX-License-Identifier: Apache-2.0
#include "replay/evaluation/report_html.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "replay/evaluation/html.hpp"
#include "replay/evaluation/report.hpp"
#include "replay/simulation/truth/label_name.hpp"
#include "replay/text.hpp"

namespace convexcut::evaluation {
namespace {

using replay::format;

constexpr const char* kPointColour = "#0072B2";
constexpr const char* kPatchColour = "#D55E00";
constexpr const char* kFColour = "#222428";
constexpr std::size_t kMostSurfaces = 20;

constexpr const char* kStyle = R"(
body{font:15px/1.5 system-ui,sans-serif;color:#222428;background:#fff;max-width:1180px;
margin:2em auto;padding:0 1.5em}
h1{font-size:1.6em;margin-bottom:.1em}h2{font-size:1.15em;margin-top:2.2em}
.quiet{color:#6b6f76}.plots{display:flex;flex-wrap:wrap;gap:1.5em}.plots figure{flex:1 1 480px;margin:0}
figcaption{color:#6b6f76;font-size:.92em}svg{width:100%;height:auto}img{max-width:100%;height:auto}
table{border-collapse:collapse;font-variant-numeric:tabular-nums}
th,td{padding:.3em .9em;text-align:right;border-bottom:1px solid #e4e4e0}
th{font-weight:600;text-align:right;color:#6b6f76}th:first-child,td:first-child,td.name{text-align:left}
.grid{stroke:#e4e4e0}.frame{stroke:#b8b8b2}.tick{font-size:11px;fill:#6b6f76}
.axis{font-size:12px;fill:#222428}
.bar{display:inline-block;height:.7em;background:#D55E00;vertical-align:baseline}
)";

[[nodiscard]] unsigned long long scan_number(const Evaluation& evaluation, std::size_t i) {
  return evaluation.scans[i].scan.index;
}

[[nodiscard]] std::string summary_row(const Evaluation& evaluation, const char* name,
                                      const Summary& summary) {
  return format("<tr><td>%s</td><td>%s</td><td>%.3f</td><td>%llu</td></tr>\n", name,
                mean_text(summary).c_str(), summary.worst(),
                scan_number(evaluation, summary.worst_at()));
}

[[nodiscard]] std::string summary_table(const Evaluation& evaluation) {
  std::string html =
      "<table><tr><th></th><th>mean ± standard deviation</th><th>worst</th><th>scan</th></tr>\n";
  const auto rows = [&](const char* of, const ScoreSummary& scores) {
    html += summary_row(evaluation, (std::string(of) + " precision").c_str(), scores.precision);
    html += summary_row(evaluation, (std::string(of) + " recall").c_str(), scores.recall);
    html += summary_row(evaluation, (std::string(of) + " F").c_str(), scores.f);
  };
  rows("Points:", evaluation.totals.points());
  rows("Plane patches:", evaluation.totals.patches());
  const PatchCounts& patches = evaluation.totals.pooled().patches;
  html += "</table>\n<p class=quiet>";
  html += format(
      "All patches together: A %llu of objects removed, B %llu of objects kept (%llu of them "
      "fragments), C %llu of structure kept, D %llu of structure lost. Precision = C / (B + C), "
      "recall = C / (C + D).",
      static_cast<unsigned long long>(patches.objects_removed),
      static_cast<unsigned long long>(patches.objects_kept),
      static_cast<unsigned long long>(patches.object_fragments),
      static_cast<unsigned long long>(patches.structure_kept),
      static_cast<unsigned long long>(patches.structure_lost));
  return html + "</p>\n";
}

// From a round number below all scores to 1.
[[nodiscard]] PlotAxis score_axis(const char* name, double least) {
  constexpr double kStep = 0.05;
  const double low = std::floor((least - 0.01) / kStep) * kStep;
  return {name, std::clamp(low, 0.0, 1.0 - kStep), 1.0};
}

[[nodiscard]] std::string tip_of(const EvaluatedScan& scan, const Score& score) {
  return format("scan %llu: precision %.3f, recall %.3f, F %.3f",
                static_cast<unsigned long long>(scan.scan.index), score.precision, score.recall,
                score.f);
}

[[nodiscard]] std::string precision_recall_plot(const Evaluation& evaluation) {
  PlotSeries points{.name = "points", .colour = kPointColour};
  PlotSeries patches{.name = "plane patches", .colour = kPatchColour};
  for (const EvaluatedScan& scan : evaluation.scans) {
    const Score by_point = scan.figures.point_score();
    const Score by_patch = scan.figures.patch_score();
    points.points.push_back({by_point.recall, by_point.precision, tip_of(scan, by_point)});
    patches.points.push_back({by_patch.recall, by_patch.precision, tip_of(scan, by_patch)});
  }
  const Totals& totals = evaluation.totals;
  const double recall = std::min(totals.points().recall.worst(), totals.patches().recall.worst());
  const double precision =
      std::min(totals.points().precision.worst(), totals.patches().precision.worst());
  return svg_plot(score_axis("recall", recall), score_axis("precision", precision),
                  {points, patches});
}

[[nodiscard]] std::string course_plot(const Evaluation& evaluation) {
  PlotSeries precision{.name = "precision", .colour = kPatchColour, .joined = true};
  PlotSeries recall{.name = "recall", .colour = kPointColour, .joined = true};
  PlotSeries f{.name = "F", .colour = kFColour, .joined = true};
  for (const EvaluatedScan& scan : evaluation.scans) {
    const Score score = scan.figures.point_score();
    const auto at = static_cast<double>(scan.scan.index);
    const std::string tip = tip_of(scan, score);
    precision.points.push_back({at, score.precision, tip});
    recall.points.push_back({at, score.recall, tip});
    f.points.push_back({at, score.f, tip});
  }
  const ScoreSummary& scores = evaluation.totals.points();
  const auto first = static_cast<double>(evaluation.scans.front().scan.index);
  const auto last = static_cast<double>(evaluation.scans.back().scan.index);
  return svg_plot(
      {"scan", first, std::max(last, first + 1.0)},
      score_axis("of points", std::min(scores.precision.worst(), scores.recall.worst())),
      {precision, recall, f});
}

[[nodiscard]] std::string surface_table(const Evaluation& evaluation) {
  const std::vector<std::size_t> order = surfaces_by_errors(evaluation);
  if (order.empty()) return "<p>No point was judged wrongly.</p>\n";
  std::uint64_t all = 0;
  for (const std::size_t surface : order) all += evaluation.by_surface[surface].wrong;
  std::string html =
      "<table><tr><th>surface</th><th>truly</th><th>points</th><th>wrong</th><th>of its points</th>"
      "<th>of all errors</th><th></th></tr>\n";
  for (std::size_t k = 0; k < std::min(order.size(), kMostSurfaces); ++k) {
    const SurfaceCounts& counts = evaluation.by_surface[order[k]];
    const double share = static_cast<double>(counts.wrong) / static_cast<double>(all);
    html += "<tr><td>" + escaped(surface_name(evaluation, order[k])) + "</td><td class=name>" +
            std::string(simulation::name_in(simulation::kLabelNames,
                                            evaluation.settings.surfaces[order[k]].label)) +
            "</td>";
    html += format(
        "<td>%s</td><td>%s</td><td>%.1f %%</td><td>%.1f %%</td><td class=name>"
        "<span class=bar style='width:%.0fpx'></span></td></tr>\n",
        replay::grouped(counts.points).c_str(), replay::grouped(counts.wrong).c_str(),
        100.0 * static_cast<double>(counts.wrong) / static_cast<double>(counts.points),
        100.0 * share, 1.0 + 160.0 * share);
  }
  html += "</table>\n";
  if (order.size() > kMostSurfaces) {
    html += format("<p class=quiet>%zu more surfaces with fewer errors.</p>\n",
                   order.size() - kMostSurfaces);
  }
  return html;
}

[[nodiscard]] std::string head(const Evaluation& evaluation, const std::string& title) {
  std::string html = "<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8>\n<title>" +
                     escaped(title) + "</title>\n<style>" + kStyle + "</style></head><body>\n<h1>" +
                     escaped(title) + "</h1>\n<p class=quiet>Scene " +
                     escaped(evaluation.settings.scene);
  html +=
      format(", seed %llu. %zu scans", static_cast<unsigned long long>(evaluation.settings.seed),
             evaluation.scans.size());
  if (evaluation.left_out > 0) {
    html += format(", %zu more left out because they are not whole", evaluation.left_out);
  }
  return html + ". Dynamic points: " + mean_text(evaluation.totals.dynamic_ratios()) +
         " of all.</p>\n";
}

[[nodiscard]] std::string map_figure(const Evaluation& evaluation, const ErrorMap& map) {
  const EvaluatedScan& scan = evaluation.scans[map.scan];
  const std::string caption = tip_of(scan, scan.figures.point_score()) + " (points)";
  return "<figure style='margin:1.5em 0'>" + inline_png(map.png, "Error map of " + caption) +
         "<figcaption>" + escaped(caption) + "</figcaption></figure>\n";
}

}  // namespace

std::vector<std::size_t> scans_to_show(const Evaluation& evaluation) {
  std::vector<std::size_t> order(evaluation.scans.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(
      order, {}, [&](std::size_t i) { return evaluation.scans[i].figures.point_score().f; });
  std::vector<std::size_t> shown{order.front()};
  if (order[order.size() / 2] != order.front()) shown.push_back(order[order.size() / 2]);
  return shown;
}

std::string report_html(const Evaluation& evaluation, const std::string& title,
                        const std::vector<ErrorMap>& maps) {
  std::string html = head(evaluation, title) + summary_table(evaluation);
  html +=
      "<h2>Precision and recall</h2>\n<div class=plots><figure>" +
      precision_recall_plot(evaluation) +
      "<figcaption>Each mark is a scan (as in figure 8 of the paper).</figcaption></figure>\n"
      "<figure>" +
      course_plot(evaluation) +
      "<figcaption>The points of each scan, in the order of time.</figcaption></figure></div>\n";
  html += "<h2>Errors by surface</h2>\n" + surface_table(evaluation);
  if (!maps.empty()) {
    html +=
        "<h2>Where the errors are</h2>\n<p class=quiet>The scan with the least F, and the one "
        "in the middle.</p>\n";
  }
  for (const ErrorMap& map : maps) html += map_figure(evaluation, map);
  return html + "</body></html>\n";
}

}  // namespace convexcut::evaluation
