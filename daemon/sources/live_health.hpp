// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "daemon/health/source_counts.hpp"
#include "daemon/sources/live_sources.hpp"

namespace convexcut::daemon {

// What a live source says of itself and what its driver has counted. `lost` of the lidar is what
// the kernel dropped: what was lost before it came here shows only in the order of the packets.
[[nodiscard]] SourceReading reading_of(const LiveSources& sources,
                                       const LiveSources::Entry& entry) noexcept;

// Whether there are no results without it: the lidar, the first IMU unless the mount is fixed, the
// bus where it has an encoder that is used.
[[nodiscard]] bool is_required(const LiveSources& sources, const LiveSources::Entry& entry,
                               const config::Config& config) noexcept;

}  // namespace convexcut::daemon
