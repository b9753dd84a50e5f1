// SPDX-License-Identifier: Apache-2.0
#include "drivers/live/ancillary.hpp"

#include <cstring>

#include "drivers/live/host_clock.hpp"

namespace convexcut::live {

Ancillary parse_ancillary(const msghdr& message) noexcept {
  Ancillary found;
  msghdr header = message;  // CMSG_NXTHDR wants it writable
  for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr; part = CMSG_NXTHDR(&header, part)) {
    if (part->cmsg_level != SOL_SOCKET) continue;
    if (part->cmsg_type == SCM_TIMESTAMPNS && part->cmsg_len == CMSG_LEN(sizeof(timespec))) {
      timespec time{};
      std::memcpy(&time, CMSG_DATA(part), sizeof time);
      found.stamp = to_host_time(time);
    } else if (part->cmsg_type == SO_RXQ_OVFL &&
               part->cmsg_len == CMSG_LEN(sizeof(std::uint32_t))) {
      std::uint32_t dropped = 0;
      std::memcpy(&dropped, CMSG_DATA(part), sizeof dropped);
      found.dropped = dropped;
    }
  }
  return found;
}

bool request_ancillary(int socket) noexcept {
  const int on = 1;
  return setsockopt(socket, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on) == 0 &&
         setsockopt(socket, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on) == 0;
}

}  // namespace convexcut::live
