// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "config/config.hpp"

namespace convexcut::daemon::testing {

// A DDS domain for tests: the built-in profile, pinned to the loopback interface without multicast
// (nothing leaves the host, no network is needed) and tagged with this process, so that programs
// that run at the same time never meet.
[[nodiscard]] config::Dds test_settings();

}  // namespace convexcut::daemon::testing
