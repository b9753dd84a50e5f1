// SPDX-License-Identifier: Apache-2.0
//
// What the kernel says beside a message, as it lays it out. Does not prove when a kernel says it:
// the sources' own tests do.
#include "drivers/live/ancillary.hpp"

#include <array>
#include <cstring>

#include <netinet/in.h>

#include <gtest/gtest.h>

#include "drivers/live/file_descriptor.hpp"
#include "drivers/live/host_clock.hpp"

namespace convexcut::live {
namespace {

// A control buffer filled part by part.
class Control {
 public:
  template <class Value>
  Control& add(int level, int type, const Value& value) {
    cmsghdr header{};
    header.cmsg_level = level;
    header.cmsg_type = type;
    header.cmsg_len = CMSG_LEN(sizeof value);
    std::memcpy(bytes_.data() + used_, &header, sizeof header);
    std::memcpy(bytes_.data() + used_ + CMSG_LEN(0), &value, sizeof value);
    used_ += CMSG_SPACE(sizeof value);
    return *this;
  }
  [[nodiscard]] Ancillary parse() {
    msghdr message{};
    message.msg_control = bytes_.data();
    message.msg_controllen = used_;
    return parse_ancillary(message);
  }

 private:
  alignas(cmsghdr) std::array<std::byte, 256> bytes_{};
  std::size_t used_ = 0;
};

constexpr timespec kTime{.tv_sec = 1'700'000'000, .tv_nsec = 123'456'789};

TEST(Ancillary, StampAndDropsAreFoundInEitherOrder) {
  for (const bool stamp_first : {true, false}) {
    Control control;
    if (stamp_first) control.add(SOL_SOCKET, SCM_TIMESTAMPNS, kTime);
    control.add(SOL_SOCKET, SO_RXQ_OVFL, std::uint32_t{7});
    if (!stamp_first) control.add(SOL_SOCKET, SCM_TIMESTAMPNS, kTime);
    const Ancillary found = control.parse();
    EXPECT_EQ(found.stamp, from_ns<HostTime>(1'700'000'000'123'456'789));
    EXPECT_EQ(found.dropped, 7U);
  }
}

TEST(Ancillary, WhatIsNotThereIsNone) {
  const Ancillary found = Control().parse();
  EXPECT_EQ(found.stamp, std::nullopt);
  EXPECT_EQ(found.dropped, std::nullopt);
}

TEST(Ancillary, OtherLevelsTypesAndLengthsAreLeftAlone) {
  const Ancillary found = Control()
                              .add(IPPROTO_IP, SCM_TIMESTAMPNS, kTime)
                              .add(SOL_SOCKET, SCM_CREDENTIALS, kTime)
                              .add(SOL_SOCKET, SCM_TIMESTAMPNS, std::uint32_t{1})
                              .add(SOL_SOCKET, SO_RXQ_OVFL, std::uint64_t{1})
                              .parse();
  EXPECT_EQ(found.stamp, std::nullopt);
  EXPECT_EQ(found.dropped, std::nullopt);
}

TEST(Ancillary, KernelGivesWhatWasRequested) {
  const FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(socket.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
  ASSERT_TRUE(request_ancillary(socket.get()));
  const HostTime before = host_now();
  ASSERT_EQ(sendto(socket.get(), "x", 1, 0, reinterpret_cast<sockaddr*>(&address), size), 1);

  char byte = 0;
  iovec vector{.iov_base = &byte, .iov_len = 1};
  alignas(cmsghdr) std::array<std::byte, kAncillarySize> control{};
  msghdr message{};
  message.msg_iov = &vector;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  ASSERT_EQ(recvmsg(socket.get(), &message, 0), 1);
  const Ancillary found = parse_ancillary(message);
  ASSERT_TRUE(found.stamp);
  EXPECT_GE(*found.stamp, before);
  EXPECT_LE(*found.stamp, host_now());
  EXPECT_FALSE(request_ancillary(-1));
}

}  // namespace
}  // namespace convexcut::live
