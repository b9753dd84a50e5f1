// SPDX-License-Identifier: Apache-2.0
//
// What the kernel says of a message beside its bytes (SO_TIMESTAMPNS, SO_RXQ_OVFL).
#pragma once

#include <cstddef>
#include <cstdint>
#include <ctime>
#include <optional>

#include <sys/socket.h>

#include "core/time.hpp"

namespace convexcut::live {

struct Ancillary {
  std::optional<HostTime> stamp;         // when the kernel received the message
  std::optional<std::uint32_t> dropped;  // by the socket since it was opened; wraps
};

// Room for both.
inline constexpr std::size_t kAncillarySize =
    CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t));

// Of a message that recvmsg() or recvmmsg() has filled. RT.
[[nodiscard]] Ancillary parse_ancillary(const msghdr& message) noexcept;

// Asks the kernel for both; false with errno set when it refuses.
[[nodiscard]] bool request_ancillary(int socket) noexcept;

}  // namespace convexcut::live
