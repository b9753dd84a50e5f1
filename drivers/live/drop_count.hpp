// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace convexcut::live {

// A socket's count of datagrams that it had no room for (SO_RXQ_OVFL, SO_MEMINFO): 32 bits that
// wrap, and that come in with a datagram as they were when it was queued, so also older than one
// that is known already. A new socket needs a new DropCount. One thread.
class DropCount {
 public:
  // How many are new since the newest count seen.
  [[nodiscard]] constexpr std::uint32_t advance(std::uint32_t count) noexcept {
    const std::uint32_t step = count - newest_;
    if (static_cast<std::int32_t>(step) <= 0) return 0;
    newest_ = count;
    return step;
  }

 private:
  std::uint32_t newest_ = 0;
};

}  // namespace convexcut::live
