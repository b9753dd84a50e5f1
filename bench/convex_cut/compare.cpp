// SPDX-License-Identifier: Apache-2.0
//
// The engine beside the paper's Algorithm 1 with hulls of Qhull, CGAL and a monotone chain, beside
// PCL's planes where there is PCL, and beside one pass over the cloud's memory, on the same clouds
// in the same run; then the robust method beside Algorithm 1 with Qhull. Prints one JSON object;
// bench.sh makes tables and plots.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "bench/convex_cut/literal.hpp"
#include "bench/convex_cut/measure.hpp"
#include "bench/convex_cut/pcl_planes.hpp"
#include "bench/convex_cut/robust_compare.hpp"
#include "bench/convex_cut/room_cloud.hpp"
#include "bench/program.hpp"
#include "core/convex_cut/engine.hpp"
#include "core/simd/simd_path.hpp"

namespace convexcut::bench {
namespace {

constexpr std::size_t kLasers = 32;
constexpr std::size_t kFiringsPerRevolution = 2170;  // HDL-32E at 10 Hz

// The paper's figure 6: as many sizes between the same bounds, here in equal ratios.
constexpr std::size_t kSizes = 88;
constexpr double kFewestPoints = 10'000;
constexpr double kMostPoints = 3'000'000;
constexpr std::size_t kSizesPerPeers = 10;  // all peers at every so manyth size

struct Case {
  std::string name;
  std::size_t firings = kFiringsPerRevolution;
  double tilt_deg = 0.0;
  ConvexCutParameters parameters{};
  unsigned rounds = 5;
  bool all_peers = true;  // CGAL, the chain and PCL too
};

struct CaseResult {
  Case tested;
  std::size_t points = 0;
  std::vector<Timing> timings;
  double differing = 0.0;  // labels of the engine that are not those of Algorithm 1 with Qhull
};

// One read of everything: no method can be faster than this. The sum keeps the reads alive.
[[nodiscard]] float read_all(const CloudView& cloud) {
  const auto sum = [](std::span<const float> values) {
    return std::reduce(values.begin(), values.end(), 0.0F);
  };
  return sum(cloud.x) + sum(cloud.y) + sum(cloud.z);
}

[[nodiscard]] CaseResult run(const Case& tested) {
  const RoomCloud cloud = room_cloud(tested.firings, tested.tilt_deg);
  const std::size_t points = cloud.x.size();
  std::vector<Label> literal(points);
  std::vector<Label> labels(points);
  ConvexCutEngine one(tested.parameters, points, 1);
  ConvexCutEngine two(tested.parameters, points, 2);
  volatile float sink = 0.0F;
  const auto literally = [&](HullFunction hull, std::vector<Label>& into) {
    return [&, hull] { label_literally(tested.parameters, cloud.view(), hull, into); };
  };
  const unsigned quick_runs = points < 500'000 ? 15 : 4;
  std::vector<Contender> contenders{
      {"qhull", literally(hull_by_qhull, literal)},
      {"engine_1t", [&] { static_cast<void>(one.label(cloud.view(), labels)); }, quick_runs},
      {"engine_2t", [&] { static_cast<void>(two.label(cloud.view(), labels)); }, quick_runs},
      {"memory", [&] { sink = sink + read_all(cloud.view()); }, quick_runs},
  };
  std::vector<Label> other(points);
  if (tested.all_peers) {
    contenders.push_back({"cgal", literally(hull_by_cgal, other)});
    contenders.push_back({"chain", literally(hull_by_monotone_chain, other)});
    if (const auto planes = pcl_planes(cloud.view())) contenders.push_back({"pcl", *planes});
  }
  CaseResult result{tested, points, measure(contenders, tested.rounds), 0.0};
  for (std::size_t i = 0; i < points; ++i) result.differing += labels[i] != literal[i] ? 1.0 : 0.0;
  return result;
}

[[nodiscard]] double median_ms(const CaseResult& result, const std::string& name) {
  const auto found = std::ranges::find(result.timings, name, &Timing::name);
  return found == result.timings.end() ? 0.0 : found->median_ms;
}

void print(const CaseResult& result, bool last) {
  std::printf(
      "    {\"name\": \"%s\", \"points\": %zu, \"tilt_deg\": %.0f, \"half_width_m\": %.3f, ",
      result.tested.name.c_str(), result.points, result.tested.tilt_deg,
      result.tested.parameters.half_width_m);
  for (const Timing& timing : result.timings) {
    std::printf("\"%s_ms\": %.4f, \"%s_p99_ms\": %.4f, \"%s_max_ms\": %.4f, ", timing.name.c_str(),
                timing.median_ms, timing.name.c_str(), timing.p99_ms, timing.name.c_str(),
                timing.max_ms);
  }
  std::printf("\"differing_labels\": %.0f}%s\n", result.differing, last ? "" : ",");
}

[[nodiscard]] std::vector<Case> cases(bool quick) {
  constexpr std::size_t kThreeMillion = 93'750;
  if (quick) {
    return {{.name = "69k", .all_peers = false},
            {.name = "69k_tilt30", .tilt_deg = 30.0, .all_peers = false},
            {.name = "3m", .firings = kThreeMillion, .rounds = 1, .all_peers = false}};
  }
  std::vector<Case> all;
  for (const double tilt_deg : {0.0, 30.0, 60.0}) {
    for (const double half_width_m : {0.02, 0.05, 0.1}) {
      const bool usual = half_width_m == ConvexCutParameters{}.half_width_m;
      std::string name = "69k";
      if (tilt_deg > 0.0) name += "_tilt" + std::to_string(static_cast<int>(tilt_deg));
      if (!usual) name += "_d" + std::to_string(static_cast<int>(half_width_m * 100.0));
      all.push_back(
          {.name = name, .tilt_deg = tilt_deg, .parameters = {.half_width_m = half_width_m}});
    }
  }
  for (std::size_t i = 0; i < kSizes; ++i) {
    const double growth = static_cast<double>(i) / static_cast<double>(kSizes - 1);
    const double points = kFewestPoints * std::pow(kMostPoints / kFewestPoints, growth);
    const auto firings = static_cast<std::size_t>(std::lround(points / kLasers));
    all.push_back({.name = "size_" + std::to_string(firings * kLasers),
                   .firings = firings,
                   .rounds = points < 200'000 ? 3U : 1U,
                   .all_peers = i % kSizesPerPeers == 0});
  }
  all.push_back({.name = "3m", .firings = kThreeMillion, .rounds = 2});
  return all;
}

void print(const RobustResult& result, bool last) {
  std::printf("    {\"scene\": \"%s\", \"points\": %zu, \"voxels\": %zu", result.scene.c_str(),
              result.points, result.voxels);
  for (const Timing& t : result.timings) {
    std::printf(R"(, "%s_ms": %.4f, "%s_p99_ms": %.4f, "%s_max_ms": %.4f)", t.name.c_str(),
                t.median_ms, t.name.c_str(), t.p99_ms, t.name.c_str(), t.max_ms);
  }
  std::printf("}%s\n", last ? "" : ",");
}

void compare_robust_in_scenes(bool quick) {
  const unsigned rounds = quick ? 6 : 25;
  const RobustResult room = compare_robust("office", rounds);
  const RobustResult hall = compare_robust("hall", rounds);
  std::printf("  \"robust\": [\n");
  print(room, false);
  print(hall, true);
  std::printf("  ],\n  \"ratio_robust_1t\": %.2f,\n  \"ratio_robust_1t_hall\": %.2f,\n",
              room.ratio(), hall.ratio());
}

int program(int argc, char** argv) {
  CLI::App app("Compares the engine with Algorithm 1 as the paper states it", "convex_cut_compare");
  bool quick = false;
  std::string simd = "auto";
  app.add_flag("--quick", quick, "Only the clouds of the promised ratios");
  app.add_option("--simd", simd, "The instruction set (see convexcut info --cpu)");
  CLI11_PARSE(app, argc, argv);
  if (!use_simd_path(simd)) {
    std::fprintf(stderr, "convex_cut_compare: --simd: this processor has no %s\n", simd.c_str());
    return 2;
  }
  std::printf("{\n  \"simd\": \"%s\",\n  \"cases\": [\n", std::string(simd_path()).c_str());
  const std::vector<Case> all = cases(quick);
  std::map<std::string, CaseResult> results;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const CaseResult result = run(all[i]);
    print(result, i + 1 == all.size());
    std::fprintf(stderr, "%s: %.1f x with one thread, %.1f x with two\n", all[i].name.c_str(),
                 median_ms(result, "qhull") / median_ms(result, "engine_1t"),
                 median_ms(result, "qhull") / median_ms(result, "engine_2t"));
    results.emplace(all[i].name, result);
  }
  const auto ratio = [&](const std::string& name, const char* engine) {
    return median_ms(results.at(name), "qhull") / median_ms(results.at(name), engine);
  };
  std::printf("  ],\n");
  compare_robust_in_scenes(quick);
  std::printf("  \"ratio_1t_69k\": %.2f,\n  \"ratio_2t_69k\": %.2f,\n", ratio("69k", "engine_1t"),
              ratio("69k", "engine_2t"));
  std::printf("  \"ratio_1t_69k_tilt30\": %.2f,\n  \"ratio_2t_69k_tilt30\": %.2f,\n",
              ratio("69k_tilt30", "engine_1t"), ratio("69k_tilt30", "engine_2t"));
  std::printf("  \"ratio_1t_3m\": %.2f,\n  \"ratio_2t_3m\": %.2f\n}\n", ratio("3m", "engine_1t"),
              ratio("3m", "engine_2t"));
  return 0;
}

}  // namespace
}  // namespace convexcut::bench

int main(int argc, char** argv) {
  return convexcut::bench::run_program("convex_cut_compare", convexcut::bench::program, argc, argv);
}
