// SPDX-License-Identifier: Apache-2.0
//
// Every stage from the datagrams of one revolution on, in turns and in one run, beside a plain
// decoder: p50, p99 and the maximum of wall time.
//
// stages_bench [--benchmark_out=FILE --benchmark_out_format=json …]
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/stages/plain_decoder.hpp"
#include "bench/stages/revolution.hpp"
#include "core/return_batch.hpp"
#include "core/scan/levelling.hpp"
#include "core/scan/scan_cutter.hpp"
#include "core/simd/simd_path.hpp"
#include "drivers/velodyne/decoder.hpp"

namespace convexcut::bench {
namespace {

constexpr std::size_t kMaxReturns = 80'000;
constexpr std::size_t kMaxFirings = 4'000;
constexpr int kRepetitions = 100;

// The revolution at every stage.
struct Stages {
  Revolution input;
  std::vector<ReturnBatch> batches;
  Scan scan;
  OrientationTrack track = swaying_rig();
  LevelledScan levelled;
  std::vector<PlainPoint> plain;
};

const velodyne::DataDecoder& decoder() {
  static const velodyne::DataDecoder made(velodyne::model_of(velodyne::ModelId::hdl32e));
  return made;
}

void decode(Stages& stages) {
  for (std::size_t i = 0; i < stages.batches.size(); ++i) {
    benchmark::DoNotOptimize(
        decoder().decode(stages.input.packets[i], kRevolutionBegin, stages.batches[i]));
  }
}

void cut(Stages& stages, ScanCutter& cutter) {
  const auto take = [&](Scan& scan) noexcept { std::swap(scan, stages.scan); };
  for (std::size_t i = 0; i < stages.batches.size(); ++i) {
    cutter.push(stages.batches[i], LidarTime{Duration{static_cast<std::int64_t>(i) * 552'960}},
                take);
  }
  cutter.finish(take);
}

void level_by_track(Stages& stages) {
  level(stages.scan, kRevolutionBegin, stages.track, Quaternion::Identity(), stages.levelled);
}

void decode_plainly(Stages& stages) {
  static const PlainDecoder plain;
  stages.plain.clear();
  for (std::size_t i = 0; i < stages.input.packets.size(); ++i) {
    plain.decode(stages.input.packets[i], static_cast<float>(i) * 552.96e-6F, stages.plain);
  }
}

Stages& stages_of(double missing) {
  static std::vector<std::pair<double, std::unique_ptr<Stages>>> made;
  for (auto& [share, stages] : made) {
    if (share == missing) return *stages;
  }
  made.emplace_back(missing, std::make_unique<Stages>());
  Stages& stages = *made.back().second;
  stages.input = revolution(missing);
  stages.batches.resize(stages.input.packets.size());
  reserve(stages.scan, kMaxReturns, kMaxFirings);
  reserve(stages.levelled, kMaxReturns);
  stages.plain.reserve(kMaxReturns);
  decode(stages);
  ScanCutter cutter({}, kMaxReturns, kMaxFirings);
  cut(stages, cutter);
  level_by_track(stages);
  return stages;
}

double at_share(const std::vector<double>& times, double share) {
  std::vector<double> sorted = times;
  std::ranges::sort(sorted);
  return sorted[static_cast<std::size_t>(static_cast<double>(sorted.size() - 1) * share)];
}

// run(Stages&): one pass over the revolution.
template <class Run>
void add(const std::string& name, Run run) {
  for (const double missing : {0.0, 0.25}) {
    benchmark::RegisterBenchmark((name + (missing == 0.0 ? "/room" : "/outdoors")).c_str(),
                                 [run, missing](benchmark::State& state) {
                                   Stages& stages = stages_of(missing);
                                   run(stages);
                                   for (auto _ : state) {  // NOLINT: the library's idiom
                                     run(stages);
                                     benchmark::ClobberMemory();
                                   }
                                   state.counters["returns"] =
                                       static_cast<double>(stages.input.returns);
                                 })
        ->UseRealTime()
        ->Iterations(1)
        ->Repetitions(kRepetitions)
        ->ReportAggregatesOnly(true)
        ->ComputeStatistics("p50", [](const auto& times) { return at_share(times, 0.5); })
        ->ComputeStatistics("p99", [](const auto& times) { return at_share(times, 0.99); })
        ->ComputeStatistics("max", [](const auto& times) { return at_share(times, 1.0); })
        ->Unit(benchmark::kMicrosecond);
  }
}

void add_all() {
  add("plain_decode", decode_plainly);
  add("plain_decode_level", [](Stages& stages) {
    decode_plainly(stages);
    level_plainly(stages.plain, kRevolutionBegin, stages.track);
  });
  add("decode", decode);
  add("cut", [cutter = std::make_shared<ScanCutter>(CutOptions{}, kMaxReturns, kMaxFirings)](
                 Stages& stages) { cut(stages, *cutter); });
  add("level", level_by_track);
  add("level_fixed", [](Stages& stages) {
    level(stages.scan, kRevolutionBegin, Quaternion::Identity(), stages.levelled);
  });
}

}  // namespace
}  // namespace convexcut::bench

int main(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  std::string shuffle = "--benchmark_enable_random_interleaving=true";
  arguments.push_back(shuffle.data());
  int count = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  benchmark::AddCustomContext("simd", std::string(convexcut::simd_path()));
  convexcut::bench::add_all();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
