// SPDX-License-Identifier: Apache-2.0
#include "replay/info/imu_info.hpp"

#include <cstdio>
#include <stdexcept>
#include <vector>

#include "daemon/sources/driver_options.hpp"
#include "drivers/xsens/mt_data_id.hpp"
#include "replay/info/info_text.hpp"
#include "replay/info/whole_recording.hpp"

namespace convexcut::replay {

ImuInfo::ImuInfo(const std::filesystem::path& file, const config::Imu& settings)
    : file_(file), recording_(file, daemon::imu_driver_options(settings), HostTime{}, samples_) {
  recording_.inspect(statistics_);
  read_whole(recording_, "imu");
  if (statistics_.xbus().frames.value() == 0) {
    throw std::runtime_error(file.string() +
                             ": no Xbus frames: expected the bytes of an MTi's "
                             "serial line, found " +
                             recording_.summary());
  }
}

void ImuInfo::print() const {
  std::printf("%s: IMU over serial, %s\n", file_.c_str(),
              recording_.stamped() ? "stamped reads" : "raw stream without stamps");
  if (recording_.stamped()) {
    std::printf("  time         %s, %.3f s\n", utc(samples_.first()).c_str(),
                seconds(samples_.duration()));
  } else {
    std::printf("  time         %.3f s by the device's clock\n", seconds(samples_.duration()));
  }
  std::printf("  device       %s\n", devices().c_str());
  std::printf("  frames       %s, %s checksum errors, %s bytes outside frames\n",
              grouped(statistics_.xbus().frames.value()).c_str(),
              grouped(statistics_.xbus().checksum_errors.value()).c_str(),
              grouped(statistics_.xbus().skipped_bytes.value()).c_str());
  std::printf("  samples      %s (%.1f Hz), %s with orientation, %s messages lost\n",
              grouped(samples_.samples()).c_str(), samples_.rate_hz(),
              grouped(samples_.orientations()).c_str(),
              grouped(recording_.counters().lost_messages.value()).c_str());
  if (recording_.stamped()) print_clock(samples_.clock());
  for (const auto& [id, item] : statistics_.items()) {
    const auto rate = item.rate_hz();
    std::printf("    0x%04X  %-36s %8s x  %s\n", id, xsens::describe_data_id(id).c_str(),
                grouped(item.count).c_str(), rate ? format("%.1f Hz", *rate).c_str() : "");
  }
}

JsonObject ImuInfo::json() const {
  std::vector<JsonObject> items;
  for (const auto& [id, item] : statistics_.items()) {
    items.push_back(JsonObject()
                        .add("id", format("0x%04X", id))
                        .add("name", xsens::describe_data_id(id))
                        .add("count", item.count)
                        .add("rate_hz", item.rate_hz().value_or(0.0), 2));
  }
  return JsonObject()
      .add("file", file_.string())
      .add("kind", "imu")
      .add("stamped", recording_.stamped())
      .add("frames", statistics_.xbus().frames.value())
      .add("checksum_errors", statistics_.xbus().checksum_errors.value())
      .add("skipped_bytes", statistics_.xbus().skipped_bytes.value())
      .add("samples", samples_.samples())
      .add("orientations", samples_.orientations())
      .add("lost", recording_.counters().lost_messages.value())
      .add("duration_s", seconds(samples_.duration()), 6)
      .add("rate_hz", samples_.rate_hz(), 2)
      .add("clock", clock_json(samples_.clock()))
      .add("items", items);
}

std::string ImuInfo::devices() const {
  std::string text;
  for (const std::string& code : statistics_.product_codes()) text += code + " ";
  for (const std::string& id : statistics_.device_ids()) text += "id " + id + " ";
  return text.empty() ? "not stated in the recording" : text;
}

}  // namespace convexcut::replay
