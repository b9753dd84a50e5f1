// SPDX-License-Identifier: Apache-2.0
#include "replay/info/lidar_inspector.hpp"

#include <algorithm>
#include <limits>

#include "daemon/pipeline/pipeline.hpp"

namespace convexcut::replay {
namespace {

CutOptions keep_everything(Azimuth cut_azimuth) {
  CutOptions options;
  options.cut_azimuth = cut_azimuth;
  options.min_range_m = 0.0;
  options.max_range_m = std::numeric_limits<double>::max();
  options.echoes = CutOptions::Echoes::both;
  return options;
}

}  // namespace

LidarInspector::LidarInspector(Azimuth cut_azimuth)
    : cutter_(keep_everything(cut_azimuth), daemon::Pipeline::kMaxReturnsPerScan,
              daemon::Pipeline::kMaxFiringsPerScan) {}

void LidarInspector::commit() noexcept {
  first_ = std::min(first_, batch_.arrival);
  last_ = std::max(last_, batch_.arrival);
  const LidarTime t = hour_clock_.unwrap(batch_.first_firing, batch_.arrival);
  first_firing_ = std::min(first_firing_, t);
  last_firing_ = std::max(last_firing_, t + batch_.span());
  clock_.observe(t, batch_.arrival - batch_.span());
  for (std::size_t i = 0; i < batch_.return_count; ++i) {
    dual_return_ = dual_return_ || batch_.echo[i] != Echo::only;
  }
  sequencer_.push(batch_, t, [this](const ReturnBatch& batch, LidarTime first_firing) {
    cutter_.push(batch, first_firing, [this](const Scan& scan) { on_scan(scan); });
  });
}

void LidarInspector::finish() {
  const auto take = [this](const Scan& scan) { on_scan(scan); };
  sequencer_.flush([this, &take](const ReturnBatch& batch, LidarTime first_firing) {
    cutter_.push(batch, first_firing, take);
  });
  cutter_.finish(take);
}

void LidarInspector::on_scan(const Scan& scan) {
  if (scan.rotor_hz > 0.0) rotor_hz_ = scan.rotor_hz;
  revolutions_.push_back({static_cast<std::uint32_t>(scan.firings.size()),
                          static_cast<std::uint32_t>(scan.size()), scan.coverage(), scan.end});
}

}  // namespace convexcut::replay
