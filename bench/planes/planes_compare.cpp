// SPDX-License-Identifier: Apache-2.0
//
// The plane extractor beside CGAL's region growing, on the same clouds of a room whose planes are
// known, in the same run. Prints one JSON object.
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "bench/convex_cut/measure.hpp"
#include "bench/convex_cut/room_cloud.hpp"
#include "bench/planes/region_growing.hpp"
#include "bench/program.hpp"
#include "core/planes/plane_extractor.hpp"

namespace convexcut::bench {
namespace {

constexpr std::size_t kLasers = 32;
constexpr std::size_t kFiringsPerRevolution = 2170;  // HDL-32E at 10 Hz
// A side of a box that shows fewer points in a revolution is no patch that one could ask for.
constexpr std::size_t kLeastSidePoints = 60;

struct Quality {
  std::size_t sides = 0;  // of the room and its furniture that are seen
  std::size_t found = 0;  // of those: one patch has half of the side's points, and most of
                          // the patch's points are the side's
  std::size_t patches = 0;
  double points_right = 0.0;  // share of all points that are in the patch of their side
};

[[nodiscard]] Quality quality_of(const RoomCloud& cloud,
                                 const std::vector<std::uint32_t>& patch_of_point) {
  const std::size_t least_points =
      kLeastSidePoints * cloud.side.size() / (kLasers * kFiringsPerRevolution);
  std::map<std::uint16_t, std::size_t> of_side;
  std::map<std::uint32_t, std::size_t> of_patch;
  std::map<std::pair<std::uint16_t, std::uint32_t>, std::size_t> both;
  for (std::size_t i = 0; i < cloud.side.size(); ++i) {
    ++of_side[cloud.side[i]];
    if (patch_of_point[i] == kNoPatch) continue;
    ++of_patch[patch_of_point[i]];
    ++both[{cloud.side[i], patch_of_point[i]}];
  }
  Quality quality;
  quality.patches = of_patch.size();
  for (const auto& [side, points] : of_side) quality.sides += points >= least_points ? 1U : 0U;
  std::size_t right = 0;
  for (const auto& [key, points] : both) {
    const auto& [side, patch] = key;
    if (2 * points < of_side[side] || 2 * points < of_patch[patch]) continue;
    right += points;
    quality.found += of_side[side] >= least_points ? 1U : 0U;
  }
  quality.points_right = static_cast<double>(right) / static_cast<double>(cloud.side.size());
  return quality;
}

void print(const std::string& method, const Timing& timing, const Quality& quality, bool last) {
  std::printf(
      "      {\"method\": \"%s\", \"median_ms\": %.2f, \"sides\": %zu, \"found\": %zu, "
      "\"recall\": %.3f, \"patches\": %zu, \"points_right\": %.4f}%s\n",
      method.c_str(), timing.median_ms, quality.sides, quality.found,
      static_cast<double>(quality.found) / static_cast<double>(quality.sides), quality.patches,
      quality.points_right, last ? "" : ",");
}

void compare(std::size_t revolutions, double tilt_deg, bool peer, bool last) {
  const RoomCloud cloud = room_cloud(revolutions * kFiringsPerRevolution, tilt_deg);
  PlaneExtractor extractor;
  std::vector<std::uint32_t> ours, theirs;
  std::vector<Contender> contenders{{"convexcut",
                                     [&] {
                                       const PlanePatches found = extractor.extract(cloud.view());
                                       ours.assign(found.patch_of_point.begin(),
                                                   found.patch_of_point.end());
                                     },
                                     revolutions == 1 ? 5U : 1U}};
  if (peer) contenders.push_back({"cgal", [&] { grow_regions(cloud.view(), {}, theirs); }});
  const std::vector<Timing> timings = measure(contenders, 1);
  std::printf("    {\"points\": %zu, \"tilt_deg\": %.0f, \"methods\": [\n", cloud.x.size(),
              tilt_deg);
  print("convexcut", timings[0], quality_of(cloud, ours), !peer);
  if (peer) print("cgal", timings[1], quality_of(cloud, theirs), true);
  std::printf("    ]}%s\n", last ? "" : ",");
}

int program(int argc, char** argv) {
  CLI::App app("Compares the plane extractor with CGAL's region growing", "planes_compare");
  bool large = false;
  app.add_flag("--large", large, "100 merged revolutions as well, without CGAL");
  CLI11_PARSE(app, argc, argv);
  std::printf("{\n  \"clouds\": [\n");
  compare(1, 0.0, true, false);
  compare(1, 30.0, true, false);
  compare(1, 60.0, true, !large);
  if (large) compare(100, 30.0, false, true);
  std::printf("  ]\n}\n");
  return 0;
}

}  // namespace
}  // namespace convexcut::bench

int main(int argc, char** argv) {
  return convexcut::bench::run_program("planes_compare", convexcut::bench::program, argc, argv);
}
