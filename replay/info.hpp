// SPDX-License-Identifier: Apache-2.0
//
// `convexcut info`: what is in recordings.
#pragma once

#include "config/config.hpp"
#include "daemon/sources/recordings.hpp"

namespace convexcut::replay {

struct InfoOptions {
  daemon::RecordingPaths recordings;  // any of them may be empty, not all
  config::Config config;
  bool json = false;
};

// Prints on stdout, warnings on stderr. Throws std::runtime_error of one line.
void info(const InfoOptions& options);

}  // namespace convexcut::replay
