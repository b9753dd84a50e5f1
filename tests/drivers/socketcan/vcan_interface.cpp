// SPDX-License-Identifier: Apache-2.0
#include "tests/drivers/socketcan/vcan_interface.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include "drivers/can/socketcan_layout.hpp"

namespace convexcut::socketcan::test {
namespace {

[[nodiscard]] bool ip(const std::string& arguments) {
  return std::system(("ip " + arguments + " 2>/dev/null").c_str()) == 0;
}

[[nodiscard]] std::string look_for_vcan() {
  const live::FileDescriptor socket(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW));
  if (!socket) return std::string("no CAN sockets in this kernel: ") + std::strerror(errno);
  const std::string probe = "vcp" + std::to_string(getpid());
  if (!ip("link add dev " + probe + " type vcan")) {
    return "`ip link add type vcan` is refused: needs root and the module vcan";
  }
  static_cast<void>(ip("link del dev " + probe));
  return {};
}

}  // namespace

const std::string& why_no_vcan() {
  static const std::string reason = look_for_vcan();
  return reason;
}

VcanInterface::VcanInterface() {
  static int number = 0;
  name_ = "vct" + std::to_string(getpid()) + "n" + std::to_string(number++);
}

void VcanInterface::add() {
  ASSERT_TRUE(ip("link add dev " + name_ + " type vcan"));
  there_ = true;
  ASSERT_TRUE(ip("link set dev " + name_ + " mtu " + std::to_string(CANFD_MTU)));
}

void VcanInterface::up() { ASSERT_TRUE(ip("link set dev " + name_ + " up")); }
void VcanInterface::down() { ASSERT_TRUE(ip("link set dev " + name_ + " down")); }

void VcanInterface::remove() {
  if (there_) {
    EXPECT_TRUE(ip("link del dev " + name_));
  }
  there_ = false;
}

std::uint64_t VcanInterface::lost_before_sockets() const {
  std::ifstream counter("/sys/class/net/" + name_ + "/statistics/rx_dropped");
  std::uint64_t lost = 0;
  EXPECT_TRUE(counter >> lost);
  return lost;
}

BusNode::BusNode(const VcanInterface& interface)
    : socket_(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)) {
  const int on = 1;
  EXPECT_EQ(setsockopt(socket_.get(), SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on), 0);
  // Sends only.
  EXPECT_EQ(setsockopt(socket_.get(), SOL_CAN_RAW, CAN_RAW_FILTER, nullptr, 0), 0);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface.name().c_str()));
  EXPECT_EQ(bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
}

void BusNode::send(const can::CanFrame& frame) const {
  canfd_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) |
               (frame.remote ? CAN_RTR_FLAG : 0U) | (frame.error ? CAN_ERR_FLAG : 0U);
  raw.len = frame.length;
  if (frame.fd) raw.flags = can::kFdFlag;
  std::memcpy(raw.data, frame.data.data(), frame.length);
  const std::size_t size = frame.fd ? CANFD_MTU : CAN_MTU;
  ASSERT_EQ(write(socket_.get(), &raw, size), static_cast<ssize_t>(size)) << std::strerror(errno);
}

}  // namespace convexcut::socketcan::test
