// SPDX-License-Identifier: Apache-2.0
//
// Convex Cut on one HDL-32E revolution of a furnished room, default parameters: the engine by
// threads and tilt, and the reference. Wall time; the agreement of their labels is shown beside it.
#include <algorithm>
#include <cstddef>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/convex_cut/room_cloud.hpp"
#include "core/convex_cut/engine.hpp"
#include "core/convex_cut/reference.hpp"

namespace convexcut::bench {
namespace {

constexpr std::size_t kFirings = 2188;  // × 32 = 70 016 points

[[nodiscard]] double structure_share(const std::vector<Label>& labels) {
  return static_cast<double>(std::ranges::count(labels, Label::structure)) /
         static_cast<double>(labels.size());
}

void engine(benchmark::State& state) {
  const RoomCloud cloud = room_cloud(kFirings, static_cast<double>(state.range(1)));
  std::vector<Label> labels(cloud.x.size());
  ConvexCutEngine engine({}, cloud.x.size(), static_cast<unsigned>(state.range(0)));
  for (auto _ : state) {  // NOLINT(clang-analyzer-deadcode.DeadStores): the library's idiom
    benchmark::DoNotOptimize(engine.label(cloud.view(), labels));
    benchmark::ClobberMemory();
  }
  std::vector<Label> expected(labels.size());
  const CutStatus status = reference::label({}, cloud.view(), expected);
  state.counters["points"] = static_cast<double>(labels.size());
  state.counters["structure"] = structure_share(labels);
  state.counters["as_reference"] = status == CutStatus::ok && labels == expected ? 1.0 : 0.0;
}
BENCHMARK(engine)
    ->ArgNames({"threads", "tilt_deg"})
    ->ArgsProduct({{1, 2}, {0, 30}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void reference_method(benchmark::State& state) {
  const RoomCloud cloud = room_cloud(kFirings, static_cast<double>(state.range(0)));
  std::vector<Label> labels(cloud.x.size());
  for (auto _ : state) {  // NOLINT(clang-analyzer-deadcode.DeadStores): the library's idiom
    benchmark::DoNotOptimize(reference::label({}, cloud.view(), labels));
    benchmark::ClobberMemory();
  }
  state.counters["points"] = static_cast<double>(labels.size());
  state.counters["structure"] = structure_share(labels);
}
BENCHMARK(reference_method)->ArgName("tilt_deg")->Arg(0)->Arg(30)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace convexcut::bench

BENCHMARK_MAIN();
