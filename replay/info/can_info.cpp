// SPDX-License-Identifier: Apache-2.0
#include "replay/info/can_info.hpp"

#include <cstdio>
#include <stdexcept>
#include <vector>

#include "daemon/sources/driver_options.hpp"
#include "replay/info/info_text.hpp"
#include "replay/info/whole_recording.hpp"

namespace convexcut::replay {

CanInfo::CanInfo(const std::filesystem::path& file, const config::Config& config)
    : file_(file), recording_(file, daemon::bus_options(config), samples_, angles_) {
  read_whole(recording_, "can");
  if (recording_.frames() == 0) {
    throw std::runtime_error(file.string() +
                             ": no CAN frames in it: expected a candump -L log or a "
                             "capture of link type CAN_SOCKETCAN (227)");
  }
}

void CanInfo::print() const {
  std::printf("%s: CAN\n", file_.c_str());
  std::printf("  frames       %s\n", recording_.summary().c_str());
  if (samples_.samples() > 0) {
    std::printf("  time         %s, %.3f s\n", utc(samples_.first()).c_str(),
                seconds(samples_.duration()));
  }
  std::printf("  IMU samples  %s (%.1f Hz), %s with orientation\n",
              grouped(samples_.samples()).c_str(), samples_.rate_hz(),
              grouped(samples_.orientations()).c_str());
  if (samples_.samples() > 0) print_clock(samples_.clock());
  if (recording_.encoder() != nullptr) {
    std::printf("  angles       %s of the stage\n", grouped(angles()).c_str());
  }
  for (const auto& [id, count] : recording_.frames_by_id()) {
    std::printf("    0x%03X  %8s x\n", id, grouped(count).c_str());
  }
}

JsonObject CanInfo::json() const {
  std::vector<JsonObject> ids;
  for (const auto& [id, count] : recording_.frames_by_id()) {
    ids.push_back(JsonObject().add("id", format("0x%03X", id)).add("count", count));
  }
  return JsonObject()
      .add("file", file_.string())
      .add("kind", "can")
      .add("frames", recording_.frames())
      .add("samples", samples_.samples())
      .add("orientations", samples_.orientations())
      .add("rate_hz", samples_.rate_hz(), 2)
      .add("clock", clock_json(samples_.clock()))
      .add("angles", angles())
      .add("ids", ids);
}

}  // namespace convexcut::replay
