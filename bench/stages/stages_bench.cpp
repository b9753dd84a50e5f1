// SPDX-License-Identifier: Apache-2.0
//
// Every stage from the datagrams of one revolution on, in turns and in one run, beside a plain
// decoder: p50, p99 and the maximum of wall time.
//
// stages_bench [--benchmark_out=FILE --benchmark_out_format=json …]
#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/convex_cut/room_cloud.hpp"
#include "bench/stages/plain_decoder.hpp"
#include "bench/stages/revolution.hpp"
#include "core/convex_cut/cloud_check.hpp"
#include "core/convex_cut/engine.hpp"
#include "core/convex_cut/plane_groups.hpp"
#include "core/convex_cut/shell_index.hpp"
#include "core/convex_cut/slice_worker.hpp"
#include "core/convex_cut/streaming_cut.hpp"
#include "core/return_batch.hpp"
#include "core/scan/levelling.hpp"
#include "core/scan/scan_cutter.hpp"
#include "core/simd/simd_path.hpp"
#include "daemon/result.hpp"
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

template <class Work>
[[nodiscard]] double timed(Work work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// run(): does the work once and returns its time in seconds.
template <class Run>
void add(const std::string& name, double returns, Run run) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [run, returns](benchmark::State& state) {
                                 static_cast<void>(run());
                                 for (auto _ : state) {  // NOLINT: the library's idiom
                                   state.SetIterationTime(run());
                                   benchmark::ClobberMemory();
                                 }
                                 state.counters["returns"] = returns;
                               })
      ->UseManualTime()
      ->Iterations(1)
      ->Repetitions(kRepetitions)
      ->ReportAggregatesOnly(true)
      ->ComputeStatistics("p50", [](const auto& times) { return at_share(times, 0.5); })
      ->ComputeStatistics("p99", [](const auto& times) { return at_share(times, 0.99); })
      ->ComputeStatistics("max", [](const auto& times) { return at_share(times, 1.0); })
      ->Unit(benchmark::kMicrosecond);
}

// run(Stages&): one pass over the revolution.
template <class Run>
void add(const std::string& name, Run run) {
  for (const double missing : {0.0, 0.25}) {
    Stages& stages = stages_of(missing);
    add(name + (missing == 0.0 ? "/room" : "/outdoors"), static_cast<double>(stages.input.returns),
        [run, &stages] { return timed([&] { run(stages); }); });
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

// From a result's commit in one thread to another's that has slept in wait() for it.
void add_hand_off() {
  struct HandOff {
    daemon::ResultRing ring{4};
    std::atomic<bool> stop{false};
    std::atomic<std::int64_t> taken_ns{0};  // steady clock; 0: not yet
    std::thread consumer{[this] {
      while (!stop.load(std::memory_order_relaxed)) {  // ends the loop, publishes nothing
        ring.wait(std::chrono::milliseconds{20});
        ring.consume([this](daemon::Result&) noexcept {
          taken_ns.store(steady_ns(), std::memory_order_release);  // pairs with the load below
        });
      }
    }};
    static std::int64_t steady_ns() {
      return std::chrono::steady_clock::now().time_since_epoch().count();
    }
    ~HandOff() {
      stop.store(true, std::memory_order_relaxed);
      consumer.join();
    }
  };
  add("hand_off_to_publisher", 1.0, [shared = std::make_shared<HandOff>()] {
    shared->taken_ns.store(0, std::memory_order_relaxed);
    std::this_thread::sleep_for(std::chrono::microseconds{200});  // the consumer sleeps again
    static_cast<void>(shared->ring.claim());
    const std::int64_t begin = HandOff::steady_ns();
    shared->ring.commit();
    std::int64_t taken = 0;
    while (taken == 0) {
      std::this_thread::yield();
      taken = shared->taken_ns.load(std::memory_order_acquire);  // pairs with the consumer's store
    }
    return static_cast<double>(taken - begin) * 1e-9;
  });
}

// Convex Cut of a revolution in a furnished room, seen by a tilted rig; in packets.
struct Labelling {
  explicit Labelling(double tilt_deg) : cloud(room_cloud(kFirings, tilt_deg)) {}

  static constexpr std::size_t kFirings = 2170;
  static constexpr std::size_t kPacket = 384;
  RoomCloud cloud;
  std::vector<Label> labels = std::vector<Label>(cloud.x.size());
  ConvexCutEngine engine{{}, cloud.x.size(), 1};
  StreamingCut streaming{{}, cloud.x.size()};
  ShellIndex index{ConvexCutParameters{}.half_width_m, cloud.x.size(), 1};
  SliceWorker worker{{}, cloud.x.size()};
  PlaneGroups planes{ConvexCutParameters{}.planes};

  [[nodiscard]] CloudView first(std::size_t count) const {
    const CloudView all = cloud.view();
    return {all.x.first(count), all.y.first(count), all.z.first(count)};
  }
  void do_slices() {
    worker.begin(index, check_cloud(cloud.view(), cloud.x.size()).extent_m);
    for (std::uint32_t i = 0; i < ConvexCutParameters{}.planes; ++i) {
      worker.process(planes.plane(i), planes.windows(i));
    }
  }
  void write_labels() {
    const std::span<const std::uint8_t> marks = worker.marks();
    for (std::size_t i = 0; i < index.size(); ++i) {
      labels[index.source(i)] = static_cast<Label>(marks[i]);
    }
  }
  // All packets but the last.
  void stream() {
    streaming.begin();
    for (std::size_t end = kPacket; end < cloud.x.size(); end += kPacket) {
      benchmark::DoNotOptimize(streaming.add(first(end)));
    }
  }
};

void add_labelling() {
  for (const int tilt_deg : {0, 30, 60}) {
    const auto shared = std::make_shared<Labelling>(tilt_deg);
    shared->index.build(shared->cloud.view());
    shared->do_slices();
    const std::string tilt = "/tilt" + std::to_string(tilt_deg);
    const auto returns = static_cast<double>(shared->cloud.x.size());
    add("order" + tilt, returns,
        [shared] { return timed([&] { shared->index.build(shared->cloud.view()); }); });
    add("slices" + tilt, returns, [shared] { return timed([&] { shared->do_slices(); }); });
    add("write_labels" + tilt, returns,
        [shared] { return timed([&] { shared->write_labels(); }); });
    add("batch" + tilt, returns, [shared] {
      return timed([&] {
        benchmark::DoNotOptimize(shared->engine.label(shared->cloud.view(), shared->labels));
      });
    });
    add("streaming_after_last_firing" + tilt, returns, [shared] {
      shared->stream();
      return timed([&] {
        benchmark::DoNotOptimize(shared->streaming.finish(shared->cloud.view(), shared->labels));
      });
    });
    add("streaming_in_all" + tilt, returns, [shared] {
      return timed([&] {
        shared->stream();
        benchmark::DoNotOptimize(shared->streaming.finish(shared->cloud.view(), shared->labels));
      });
    });
  }
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
  convexcut::bench::add_labelling();
  convexcut::bench::add_hand_off();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
