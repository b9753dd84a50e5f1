// SPDX-License-Identifier: Apache-2.0
#include "drivers/socketcan/can_socket.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include "drivers/can/controller_state.hpp"
#include "drivers/live/ancillary.hpp"

namespace convexcut::socketcan {
namespace {

// Not bus errors (0x080): a faulty bus sends thousands a second of them, and their consequences are
// reported by the others.
constexpr can_err_mask_t kErrorClasses = can::kTransmitTimeout | can::kControllerProblem |
                                         can::kTransceiverProblem | can::kNoAcknowledge |
                                         can::kBusOff | can::kRestarted;

// Some thousand frames: the kernel counts about 1 kB for each.
constexpr int kReceiveBufferBytes = 2 << 20;

[[nodiscard]] bool set(int socket, int level, int option, const void* value,
                       std::size_t size) noexcept {
  return setsockopt(socket, level, option, value, static_cast<socklen_t>(size)) == 0;
}

void enlarge_receive_buffer(int socket) noexcept {
  // Beyond net.core.rmem_max where we may; what is refused shows in the drop count.
  if (!set(socket, SOL_SOCKET, SO_RCVBUFFORCE, &kReceiveBufferBytes, sizeof kReceiveBufferBytes)) {
    static_cast<void>(
        set(socket, SOL_SOCKET, SO_RCVBUF, &kReceiveBufferBytes, sizeof kReceiveBufferBytes));
  }
}

[[nodiscard]] bool set_options(int socket, std::span<const can_filter> filters) noexcept {
  const int on = 1;
  enlarge_receive_buffer(socket);
  return set(socket, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), filters.size_bytes()) &&
         set(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &kErrorClasses, sizeof kErrorClasses) &&
         set(socket, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on) &&
         live::request_ancillary(socket);
}

[[nodiscard]] bool bind_to(int socket, const std::string& interface) noexcept {
  ifreq request{};
  if (interface.empty() || interface.size() >= sizeof request.ifr_name) {
    errno = ENODEV;
    return false;
  }
  std::copy(interface.begin(), interface.end(), request.ifr_name);
  if (ioctl(socket, SIOCGIFINDEX, &request) != 0) return false;
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = request.ifr_ifindex;
  return bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

// bind() succeeds on an interface that is down and leaves ENETDOWN to be read.
[[nodiscard]] int pending_error(int socket) noexcept {
  int error = 0;
  socklen_t size = sizeof error;
  return getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

}  // namespace

std::vector<can_filter> exact_filters(std::span<const can::CanId> ids) {
  std::vector<can_filter> filters;
  filters.reserve(ids.size());
  for (const can::CanId& id : ids) {
    const canid_t flags = id.extended ? CAN_EFF_FLAG : 0;
    const canid_t bits = id.extended ? CAN_EFF_MASK : CAN_SFF_MASK;
    filters.push_back({.can_id = id.id | flags, .can_mask = bits | CAN_EFF_FLAG | CAN_RTR_FLAG});
  }
  return filters;
}

OpenedSocket open_can_socket(const std::string& interface,
                             std::span<const can_filter> filters) noexcept {
  live::FileDescriptor socket(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (!socket) return {.socket = {}, .error = errno};
  // Filters first: a socket that is bound without them receives everything.
  if (!set_options(socket.get(), filters) || !bind_to(socket.get(), interface)) {
    return {.socket = {}, .error = errno};
  }
  if (const int error = pending_error(socket.get()); error != 0) {
    return {.socket = {}, .error = error};
  }
  return {.socket = std::move(socket), .error = 0};
}

}  // namespace convexcut::socketcan
