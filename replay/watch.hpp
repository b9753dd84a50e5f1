// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdio>
#include <optional>

#include "config/config.hpp"

namespace convexcut::replay {

struct WatchOptions {
  config::Dds dds;  // domain, profile and topic names, as the daemon has them
  bool json = false;
  std::optional<std::chrono::seconds> duration;  // not given: until SIGINT or SIGTERM
  // After this long without a publisher it says on stderr what to check.
  std::chrono::seconds patience{3};
};

// Listens to a daemon's topics like any DDS program and prints one line a second to out: what
// arrives, and what the daemon says of it. Gives 0 when data came, 1 when none did. Throws
// daemon::DdsError when it cannot take part in the domain, std::system_error when out cannot be
// written.
int watch(const WatchOptions& options, std::FILE* out);

}  // namespace convexcut::replay
