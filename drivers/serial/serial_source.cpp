// SPDX-License-Identifier: Apache-2.0
#include "drivers/serial/serial_source.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <poll.h>

#include "drivers/live/host_clock.hpp"

namespace convexcut::serial {
namespace {

// A line that never falls silent must not keep the caller.
constexpr int kMaxReadsInARow = 16;

}  // namespace

SerialSource::SerialSource(SerialSourceOptions options, xsens::ImuDriver& driver, live::RawTap* tap)
    : options_(std::move(options)), driver_(driver), tap_(tap) {}

void SerialSource::receive(Duration wait) noexcept {
  const auto now = live::Steady::now();
  if (!port_.is_open() && pause_.take(now)) open();
  if (port_.is_open()) {
    wait_for_input(wait);
  } else {
    const std::timespec pause = live::to_timespec(pause_.left(now, wait));
    ::clock_nanosleep(CLOCK_MONOTONIC, 0, &pause, nullptr);
  }
}

void SerialSource::open() noexcept {
  const int error = port_.open(options_.device, options_.baud);
  if (error != 0) return status_.set(live::LinkState::closed, error);
  counters_.opened.add();
  low_latency_.store(port_.low_latency(), std::memory_order_relaxed);
  status_.set_open();
}

void SerialSource::lose(int error) noexcept {
  port_.close();
  counters_.unplugged.add();
  low_latency_.store(false, std::memory_order_relaxed);
  status_.set(live::LinkState::closed, error);
  pause_.restart(live::Steady::now());
}

void SerialSource::wait_for_input(Duration wait) noexcept {
  pollfd poll{port_.fd(), POLLIN, 0};
  const std::timespec timeout = live::to_timespec(std::max(wait, Duration{0}));
  if (::ppoll(&poll, 1, &timeout, nullptr) <= 0) return;  // nothing came, or a signal did
  // Also when it is hung up: the read says what became of it.
  drain();
}

void SerialSource::drain() noexcept {
  for (int i = 0; i < kMaxReadsInARow; ++i) {
    std::size_t size = 0;
    const int error = port_.read(buffer_, size);
    const HostTime stamp = live::host_now();
    if (error == EAGAIN || error == EINTR) return;
    if (error != 0) return lose(error);
    deliver(wire::Bytes(buffer_).first(size), stamp);
    if (size < buffer_.size()) return;
  }
}

void SerialSource::deliver(wire::Bytes bytes, HostTime stamp) noexcept {
  counters_.reads.add();
  counters_.bytes.add(bytes.size());
  if (tap_ != nullptr) {
    tap_->on_record({.stamp = stamp, .kind = capture::RecordKind::serial, .payload = bytes});
  }
  driver_.on_bytes(bytes, stamp);
}

}  // namespace convexcut::serial
