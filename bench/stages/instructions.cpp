// SPDX-License-Identifier: Apache-2.0
//
// Does one stage some times over, for a tool that counts its instructions: two runs with different
// numbers of rounds tell those of a round (scripts/check-instructions.sh).
//
// bench_instructions decode|level|label|stream|robust ROUNDS SIMD: prints the points of a round.
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/convex_cut/room_cloud.hpp"
#include "bench/stages/revolution.hpp"
#include "core/convex_cut/engine.hpp"
#include "core/convex_cut/robust/robust_cut.hpp"
#include "core/convex_cut/streaming_cut.hpp"
#include "core/return_batch.hpp"
#include "core/scan/levelling.hpp"
#include "core/scan/scan_cutter.hpp"
#include "core/simd/simd_path.hpp"
#include "drivers/velodyne/decoder.hpp"

namespace convexcut::bench {
namespace {

constexpr std::size_t kFirings = 700;

// Does a stage once and returns how many points it had.
using Round = std::function<std::size_t()>;

[[nodiscard]] Round decoding() {
  const auto input = std::make_shared<Revolution>(revolution(0.25));
  return [input, decoder = velodyne::DataDecoder(velodyne::model_of(velodyne::ModelId::hdl32e)),
          batch = std::make_shared<ReturnBatch>()] {
    std::size_t returns = 0;
    for (const auto& packet : input->packets) {
      static_cast<void>(decoder.decode(packet, kRevolutionBegin, *batch));
      returns += batch->return_count;
    }
    return returns;
  };
}

[[nodiscard]] Round levelling() {
  const RoomCloud cloud = room_cloud(kFirings, 0.0);
  const auto scan = std::make_shared<Scan>();
  scan->x_lidar = cloud.x;
  scan->y_lidar = cloud.y;
  scan->z_lidar = cloud.z;
  scan->intensity.resize(cloud.x.size());
  scan->ring.resize(cloud.x.size());
  scan->time_ns.resize(cloud.x.size());
  for (std::uint32_t i = 0; i < kFirings; ++i) {
    scan->firings.push_back({LidarTime{Duration{46'080} * i}, 32 * i, 32});
  }
  const auto levelled = std::make_shared<LevelledScan>();
  reserve(*levelled, cloud.x.size());
  return [scan, levelled, track = std::make_shared<OrientationTrack>(swaying_rig())] {
    level(*scan, kRevolutionBegin, *track, Quaternion::Identity(), *levelled);
    return levelled->size();
  };
}

[[nodiscard]] Round labelling() {
  const auto cloud = std::make_shared<RoomCloud>(room_cloud(kFirings, 0.0));
  const auto labels = std::make_shared<std::vector<Label>>(cloud->x.size());
  const auto engine = std::make_shared<ConvexCutEngine>(ConvexCutParameters{}, labels->size(), 1);
  return [cloud, labels, engine] {
    static_cast<void>(engine->label(cloud->view(), *labels));
    return labels->size();
  };
}

[[nodiscard]] Round streaming() {
  const auto cloud = std::make_shared<RoomCloud>(room_cloud(kFirings, 0.0));
  const auto labels = std::make_shared<std::vector<Label>>(cloud->x.size());
  const auto cut = std::make_shared<StreamingCut>(ConvexCutParameters{}, labels->size());
  return [cloud, labels, cut] {
    const CloudView all = cloud->view();
    cut->begin();
    for (std::size_t end = 0; end < all.size(); end += 384) {
      static_cast<void>(cut->add({all.x.first(end), all.y.first(end), all.z.first(end)}));
    }
    static_cast<void>(cut->finish(all, *labels));
    return labels->size();
  };
}

// With its window full.
[[nodiscard]] Round robust() {
  constexpr std::uint32_t kWindow = 3;
  const auto cloud = std::make_shared<RoomCloud>(room_cloud(kFirings, 30.0));
  const auto labels = std::make_shared<std::vector<Label>>(cloud->x.size());
  RobustParameters parameters;
  parameters.window = kWindow;
  const auto cut = std::make_shared<RobustCut>(parameters, labels->size());
  const Round round = [cloud, labels, cut] {
    static_cast<void>(cut->label(cloud->view(), *labels));
    return labels->size();
  };
  for (std::uint32_t i = 0; i < kWindow; ++i) round();
  return round;
}

int program(const std::vector<std::string>& arguments) {
  const std::map<std::string, Round (*)()> stages{{"decode", decoding},
                                                  {"level", levelling},
                                                  {"label", labelling},
                                                  {"stream", streaming},
                                                  {"robust", robust}};
  if (arguments.size() != 3 || !stages.contains(arguments[0]) || !use_simd_path(arguments[2])) {
    std::fputs("bench_instructions: expected decode|level|label|stream|robust ROUNDS SIMD\n",
               stderr);
    return 2;
  }
  const Round round = stages.at(arguments[0])();
  std::size_t points = 0;
  for (long left = std::strtol(arguments[1].c_str(), nullptr, 10); left > 0; --left) {
    points = round();
  }
  std::printf("%zu\n", points);
  return 0;
}

}  // namespace
}  // namespace convexcut::bench

int main(int argc, char** argv) {
  return convexcut::bench::program(std::vector<std::string>(argv + 1, argv + argc));
}
