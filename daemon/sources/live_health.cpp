// SPDX-License-Identifier: Apache-2.0
#include "daemon/sources/live_health.hpp"

#include <algorithm>

namespace convexcut::daemon {

SourceReading reading_of(const LiveSources& sources, const LiveSources::Entry& entry) noexcept {
  if (entry.role == SourceRole::lidar) {
    SourceReading reading = reading_of(entry.source, sources.lidar_driver().counters());
    reading.lost = sources.kernel_drops();
    return reading;
  }
  return reading_of(entry.source, sources.imu_driver()->counters());
}

bool is_required(const LiveSources& sources, const LiveSources::Entry& entry,
                 const config::Config& config) noexcept {
  if (entry.role == SourceRole::lidar) return true;
  if (config.mount.orientation != config::MountOrientation::imu) return false;
  const auto first =
      std::ranges::find(sources.entries(), SourceRole::imu, &LiveSources::Entry::role);
  return &*first == &entry;
}

}  // namespace convexcut::daemon
