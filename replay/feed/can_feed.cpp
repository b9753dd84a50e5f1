// SPDX-License-Identifier: Apache-2.0
#include "replay/feed/can_feed.hpp"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <linux/can.h>
#include <unistd.h>

#include "drivers/socketcan/can_socket.hpp"

namespace convexcut::replay {

CanFeed::CanFeed(CanFeedOptions options, const Faults& faults, std::uint64_t seed)
    : options_(std::move(options)), faults_(faults), dice_(seed) {
  rewind();
  open_socket();
}

// Without filters nothing is received.
void CanFeed::open_socket() {
  socketcan::OpenedSocket opened = socketcan::open_can_socket(options_.interface, {});
  socket_ = std::move(opened.socket);
  if (socket_) return;
  std::string hint;
  if (opened.error == EAFNOSUPPORT) hint = ": this kernel has no CAN (expected the module can_raw)";
  if (opened.error == ENODEV) hint = ": expected a CAN interface (ip link add vcan0 type vcan)";
  if (opened.error == ENETDOWN) hint = ": expected it to be up (ip link set vcan0 up)";
  throw std::runtime_error("--can-interface " + options_.interface + ": " +
                           std::strerror(opened.error) + hint);
}

void CanFeed::rewind() {
  frames_ = std::make_unique<recording::CanFrames>(options_.file);
  have_frame_ = false;
  newest_us_ = first_us_;
  gained_ = {};
  first_of_loop_ = true;
}

std::optional<HostTime> CanFeed::next_stamp() {
  while (!have_frame_) {
    if (!frames_->next(frame_)) return std::nullopt;
    have_frame_ = !frame_.error;
  }
  return frame_.stamp;
}

void CanFeed::send(const PlayedTime& time) {
  have_frame_ = false;
  const auto message = options_.ids.find(frame_);
  if (message == can::XsensMessage::sample_time && frame_.length >= sizeof(std::uint32_t)) {
    move_time(time);
  } else if (message == can::XsensMessage::group_counter &&
             frame_.length >= sizeof(std::uint16_t)) {
    move_counter();
  }
  if (dice_.chance(faults_.loss)) {
    ++lost_;
  } else {
    transmit();
  }
}

void CanFeed::move_time(const PlayedTime& time) {
  const auto recorded = wire::load_be<std::uint32_t>(frame_.data, 0);
  if (newest_us_) {  // the shorter way around its 32 bits
    gained_ += std::chrono::microseconds{static_cast<std::int32_t>(recorded - *newest_us_)};
  }
  if (!first_us_) first_us_ = recorded;
  newest_us_ = recorded;
  const auto shift = std::chrono::duration_cast<std::chrono::microseconds>(time.shift(gained_));
  wire::store_be<std::uint32_t>(frame_.data, 0,
                                static_cast<std::uint32_t>(recorded + shift.count()));
}

void CanFeed::move_counter() {
  const auto recorded = wire::load_be<std::uint16_t>(frame_.data, 0);
  if (first_of_loop_ && newest_counter_) {
    counter_shift_ = static_cast<std::uint16_t>(*newest_counter_ + 1 - recorded);
  }
  first_of_loop_ = false;
  newest_counter_ = static_cast<std::uint16_t>(recorded + counter_shift_);
  wire::store_be<std::uint16_t>(frame_.data, 0, *newest_counter_);
}

void CanFeed::transmit() {
  canfd_frame out{};
  out.can_id = frame_.id;
  if (frame_.extended) out.can_id |= CAN_EFF_FLAG;
  if (frame_.remote) out.can_id |= CAN_RTR_FLAG;
  out.len = frame_.length;
  std::memcpy(out.data, frame_.data.data(), frame_.length);
  const std::size_t size = frame_.fd ? sizeof(canfd_frame) : sizeof(can_frame);
  if (::write(socket_.get(), &out, size) == static_cast<ssize_t>(size)) {
    ++sent_;
    return;
  }
  ++not_sent_;  // its queue is full, or the bus is off: a device would not know what to do either
  if (sent_ > 0) return;
  throw std::runtime_error("--can-interface " + options_.interface +
                           ": cannot send: " + std::strerror(errno));
}

}  // namespace convexcut::replay
