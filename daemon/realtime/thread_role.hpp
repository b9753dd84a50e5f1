// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace convexcut::daemon {

// What a thread of the daemon does, from which its priority and its CPUs follow. Why they are
// ordered like this: docs/design/realtime.md.
enum class ThreadRole : std::uint8_t {
  receive,    // stamps and decodes what comes in: RT
  worker,     // RT
  publish,    // writes to DDS on time: scheduled like RT, though DDS allocates and locks
  transport,  // DDS's own: the publishers wait for locks that these hold
  other,      // plays recordings, watches: not scheduled specially
};

// Threads that allocate nothing, lock nothing and have all their memory.
[[nodiscard]] constexpr bool is_realtime(ThreadRole role) noexcept {
  return role == ThreadRole::receive || role == ThreadRole::worker;
}

}  // namespace convexcut::daemon
