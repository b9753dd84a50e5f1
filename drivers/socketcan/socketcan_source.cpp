// SPDX-License-Identifier: Apache-2.0
#include "drivers/socketcan/socketcan_source.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include <poll.h>

#include "drivers/capture/record.hpp"
#include "drivers/socketcan/can_socket.hpp"
#include "drivers/wire.hpp"

namespace convexcut::socketcan {
namespace {

// Waits until `descriptor` is readable or has failed; without one (-1) until the time is over.
[[nodiscard]] bool wait_readable(int descriptor, Duration wait) noexcept {
  pollfd entry{.fd = descriptor, .events = POLLIN, .revents = 0};
  const timespec limit = live::to_timespec(std::max(wait, Duration::zero()));
  return ppoll(&entry, 1, &limit, nullptr) > 0;
}

// From what a socket gives to what a capture holds, in place.
void to_capture_layout(wire::WritableBytes record) noexcept {
  canid_t id = 0;
  std::memcpy(&id, record.data() + can::kSocketCanIdOffset, sizeof id);
  wire::store_be<std::uint32_t>(record, can::kSocketCanIdOffset, id);
  if (record.size() == can::kFdRecordSize) {
    record[can::kSocketCanFdFlagsOffset] |= std::byte{can::kFdFlag};
  }
}

}  // namespace

SocketCanSource::SocketCanSource(const SocketCanOptions& options, can::FrameReceiver& receiver,
                                 live::RawTap* tap)
    : options_(options), filters_(exact_filters(options.ids)), receiver_(receiver), tap_(tap) {
  for (std::size_t i = 0; i < kBatch; ++i) {
    batch_.vectors[i] = {.iov_base = batch_.records[i].data(), .iov_len = batch_.records[i].size()};
    batch_.messages[i].msg_hdr.msg_iov = &batch_.vectors[i];
    batch_.messages[i].msg_hdr.msg_iovlen = 1;
    batch_.messages[i].msg_hdr.msg_control = batch_.ancillary[i].data();
  }
}

void SocketCanSource::receive(Duration wait) noexcept {
  if (!socket_) {
    wait_to_open(wait);
    return;
  }
  if (wait_readable(socket_.get(), std::min(wait, time_to_flush()))) {
    read_batch();
  } else if (time_to_flush() <= Duration::zero()) {
    flush();
  }
}

Duration SocketCanSource::time_to_flush() const noexcept {
  if (!unflushed_) return Duration::max();
  return options_.idle - (live::Steady::now() - last_frame_);
}

void SocketCanSource::wait_to_open(Duration wait) noexcept {
  if (const Duration pause = opening_.left(live::Steady::now(), wait); pause > Duration::zero()) {
    static_cast<void>(wait_readable(-1, pause));
  }
  if (opening_.take(live::Steady::now())) open();
}

void SocketCanSource::open() noexcept {
  counters_.open_attempts.add();
  OpenedSocket opened = open_can_socket(options_.interface, filters_);
  if (!opened.socket) return status_.set(live::LinkState::closed, opened.error);
  counters_.opened.add();
  socket_ = std::move(opened.socket);
  drops_ = {};
  // What the controller was in before is not known any more.
  controller_.store(can::ControllerState::active, std::memory_order_relaxed);
  status_.set_open();
}

void SocketCanSource::close(int error) noexcept {
  // The kernel reports the loss ahead of frames that came before it.
  while (take_batch() > 0) {
  }
  flush();
  socket_.reset();
  counters_.closed.add();
  status_.set(live::LinkState::closed, error);
}

void SocketCanSource::read_batch() noexcept {
  if (take_batch() >= 0) return;
  const int error = errno;
  if (error != EAGAIN && error != EINTR) close(error);
}

int SocketCanSource::take_batch() noexcept {
  for (mmsghdr& message : batch_.messages) {
    message.msg_hdr.msg_controllen = live::kAncillarySize;
  }
  const int count = recvmmsg(socket_.get(), batch_.messages.data(), kBatch, MSG_DONTWAIT, nullptr);
  for (int i = 0; i < count; ++i) take(batch_.messages[static_cast<std::size_t>(i)]);
  if (count > 0) last_frame_ = live::Steady::now();
  return count;
}

void SocketCanSource::take(mmsghdr& message) noexcept {
  const live::Ancillary ancillary = live::parse_ancillary(message.msg_hdr);
  if (ancillary.dropped) counters_.dropped.add(drops_.advance(*ancillary.dropped));
  const bool whole = (message.msg_hdr.msg_flags & MSG_TRUNC) == 0 &&
                     (message.msg_len == CAN_MTU || message.msg_len == CANFD_MTU);
  if (!whole) return counters_.malformed.add();
  const wire::WritableBytes record(static_cast<std::byte*>(message.msg_hdr.msg_iov->iov_base),
                                   message.msg_len);
  to_capture_layout(record);
  const HostTime stamp = ancillary.stamp ? *ancillary.stamp : live::host_now();
  if (tap_ != nullptr) {
    tap_->on_record({.stamp = stamp, .kind = capture::RecordKind::can, .payload = record});
  }
  can::CanFrame frame;
  if (can::decode_socketcan(record, can::IdOrder::big_endian, stamp, frame) !=
      can::RecordStatus::ok) {
    return counters_.malformed.add();
  }
  follow_controller(frame);
  counters_.frames.add();
  unflushed_ = true;
  receiver_.on_frame(frame);
}

void SocketCanSource::follow_controller(const can::CanFrame& frame) noexcept {
  if (frame.error) counters_.error_frames.add();
  const can::ControllerReport report = can::next_state(controller(), frame);
  if (report.restarted) counters_.restarts.add();
  if (report.receive_overflow) counters_.controller_overflows.add();
  if (!report.changed) return;
  if (report.state == can::ControllerState::passive) counters_.error_passive.add();
  const bool off = report.state == can::ControllerState::bus_off;
  if (off) counters_.bus_off.add();
  controller_.store(report.state, std::memory_order_relaxed);
  if (off) {
    status_.set(live::LinkState::error, 0);
  } else {
    status_.set_open();
  }
}

void SocketCanSource::flush() noexcept {
  if (!unflushed_) return;
  unflushed_ = false;
  receiver_.flush();
}

}  // namespace convexcut::socketcan
