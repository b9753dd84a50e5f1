// SPDX-License-Identifier: Apache-2.0
#include "replay/feed/datagram_link.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace convexcut::replay {
namespace {

constexpr std::size_t kLongestDatagramGarbage = 1500;

}  // namespace

DatagramLink::DatagramLink(const std::string& address, const Faults& faults, std::uint64_t seed)
    : address_(address),
      faults_(faults),
      dice_(seed),
      socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  in_addr parsed{};
  if (::inet_pton(AF_INET, address.c_str(), &parsed) != 1) {
    throw std::runtime_error("--to-address: expected an IPv4 address, found \"" + address + "\"");
  }
  address_be_ = parsed.s_addr;
  const int on = 1;
  if (!socket_ || ::setsockopt(socket_.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof(on)) != 0) {
    throw std::runtime_error(std::string("cannot make a UDP socket: ") + std::strerror(errno));
  }
}

void DatagramLink::send(Time now, std::uint16_t port, wire::Bytes payload) {
  if (dice_.chance(faults_.loss)) {
    ++counts_.lost;
    return;
  }
  Waiting datagram{now, port, {payload.begin(), payload.end()}};
  if (dice_.chance(faults_.reorder) && !held_) {
    ++counts_.reordered;
    held_ = std::move(datagram);
    return;
  }
  const bool twice = dice_.chance(faults_.duplicate);
  if (twice) {
    ++counts_.duplicated;
    enqueue(now, datagram);
  }
  enqueue(now, std::move(datagram));
  release(now);
  if (dice_.chance(faults_.garbage)) {
    ++counts_.garbage;
    enqueue(now, {now, port, dice_.noise(kLongestDatagramGarbage), true});
  }
}

void DatagramLink::release(Time now) {
  if (!held_) return;
  enqueue(now, std::move(*held_));
  held_.reset();
}

void DatagramLink::enqueue(Time now, Waiting datagram) {
  datagram.due = now + dice_.up_to(faults_.delay);
  if (!waiting_.empty()) datagram.due = std::max(datagram.due, waiting_.back().due);
  waiting_.push_back(std::move(datagram));
  send_due(now);
}

std::optional<DatagramLink::Time> DatagramLink::next_due() const {
  if (waiting_.empty()) return std::nullopt;
  return waiting_.front().due;
}

void DatagramLink::send_due(Time now) {
  while (!waiting_.empty() && waiting_.front().due <= now) {
    transmit(waiting_.front());
    waiting_.pop_front();
  }
}

void DatagramLink::transmit(const Waiting& datagram) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(datagram.port);
  to.sin_addr.s_addr = address_be_;
  const ssize_t sent = ::sendto(socket_.get(), datagram.payload.data(), datagram.payload.size(), 0,
                                reinterpret_cast<const sockaddr*>(&to), sizeof(to));
  if (sent >= 0) {
    counts_.sent += datagram.garbage ? 0 : 1;
    return;
  }
  // A sensor does not care. But when nothing goes from the start, the user has to know.
  ++counts_.not_sent;
  if (counts_.sent == 0) {
    throw std::runtime_error("cannot send to " + address_ + ":" + std::to_string(datagram.port) +
                             ": " + std::strerror(errno));
  }
}

}  // namespace convexcut::replay
