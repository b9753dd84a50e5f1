// SPDX-License-Identifier: Apache-2.0
//
// Live sources joined to a recorder, as the configuration asks.
#pragma once

#include "config/config.hpp"
#include "daemon/sources/live_sources.hpp"
#include "drivers/recorder/recorder.hpp"

namespace convexcut::daemon {

[[nodiscard]] recorder::RecorderOptions recorder_options(const config::Record& record);

// The recorder outlives the sources that are made with its taps.
[[nodiscard]] LiveTaps taps_of(recorder::Recorder& recorder) noexcept;

}  // namespace convexcut::daemon
