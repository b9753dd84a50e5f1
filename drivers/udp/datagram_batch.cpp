// SPDX-License-Identifier: Apache-2.0
#include "drivers/udp/datagram_batch.hpp"

#include <cassert>
#include <cerrno>
#include <cstring>

#include "drivers/live/host_clock.hpp"

namespace convexcut::udp {
namespace {

template <class Value>
Value value_of(const cmsghdr* header) noexcept {
  Value value;
  std::memcpy(&value, CMSG_DATA(header), sizeof(value));
  return value;
}

void read_control(const cmsghdr& header, Datagram& datagram) noexcept {
  if (header.cmsg_level == SOL_SOCKET && header.cmsg_type == SCM_TIMESTAMPNS) {
    datagram.stamp = live::to_host_time(value_of<std::timespec>(&header));
  } else if (header.cmsg_level == SOL_SOCKET && header.cmsg_type == SO_RXQ_OVFL) {
    datagram.dropped_before_it = value_of<std::uint32_t>(&header);
  } else if (header.cmsg_level == IPPROTO_IP && header.cmsg_type == IP_PKTINFO) {
    datagram.destination = {ntohl(value_of<in_pktinfo>(&header).ipi_addr.s_addr)};
  }
}

}  // namespace

DatagramBatch::DatagramBatch() noexcept {
  for (std::size_t i = 0; i < kCapacity; ++i) {
    vectors_[i] = {payloads_[i].data(), kMaxPayload};
    messages_[i].msg_hdr.msg_iov = &vectors_[i];
    messages_[i].msg_hdr.msg_iovlen = 1;
    messages_[i].msg_hdr.msg_name = &senders_[i];
    messages_[i].msg_hdr.msg_control = &controls_[i];
  }
}

int DatagramBatch::receive(int socket) noexcept {
  size_ = 0;
  for (mmsghdr& message : messages_) {  // the last call left what it had written
    message.msg_hdr.msg_namelen = sizeof(sockaddr_in);
    message.msg_hdr.msg_controllen = sizeof(Control);
    message.msg_hdr.msg_flags = 0;
  }
  const int count = ::recvmmsg(socket, messages_.data(), kCapacity, MSG_DONTWAIT, nullptr);
  if (count < 0) return errno;
  size_ = static_cast<std::size_t>(count);
  return 0;
}

Datagram DatagramBatch::operator[](std::size_t index) const noexcept {
  assert(index < size_);
  const mmsghdr& message = messages_[index];
  Datagram datagram;
  datagram.payload = wire::Bytes(payloads_[index]).first(message.msg_len);
  datagram.truncated = (message.msg_hdr.msg_flags & MSG_TRUNC) != 0;
  datagram.source = {ntohl(senders_[index].sin_addr.s_addr)};
  datagram.source_port = ntohs(senders_[index].sin_port);
  datagram.stamp = HostTime::min();
  msghdr header = message.msg_hdr;  // CMSG_NXTHDR wants it writable
  for (cmsghdr* control = CMSG_FIRSTHDR(&header); control != nullptr;
       control = CMSG_NXTHDR(&header, control)) {
    read_control(*control, datagram);
  }
  if (datagram.stamp == HostTime::min()) datagram.stamp = live::host_now();
  return datagram;
}

}  // namespace convexcut::udp
