// SPDX-License-Identifier: Apache-2.0
#include "daemon/sources/live_health.hpp"

#include <algorithm>

namespace convexcut::daemon {

SourceReading reading_of(const LiveSources& sources, const LiveSources::Entry& entry) noexcept {
  if (&entry.source == &sources.lidar()) {
    SourceReading reading = reading_of(entry.source, sources.lidar_driver().counters());
    reading.lost = sources.lidar().counters().kernel_drops.value();
    return reading;
  }
  if (&entry.source == sources.imu()) {
    return reading_of(entry.source, sources.imu_driver()->counters());
  }
  SourceReading reading = reading_of(entry.source, sources.bus()->imu().counters());
  if (const can::EncoderDriver* encoder = sources.bus()->encoder()) {
    reading.valid += encoder->counters().samples.value();
    reading.invalid += encoder->counters().short_frames.value();
  }
  return reading;
}

bool is_required(const LiveSources& sources, const LiveSources::Entry& entry,
                 const config::Config& config) noexcept {
  if (entry.role == SourceRole::lidar) return true;
  if (&entry.source == sources.can() && config.encoder.use != config::EncoderUse::off) return true;
  if (config.mount.orientation != config::MountOrientation::imu) return false;
  const auto first =
      std::ranges::find(sources.entries(), SourceRole::imu, &LiveSources::Entry::role);
  return &*first == &entry;
}

}  // namespace convexcut::daemon
