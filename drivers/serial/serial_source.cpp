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
    : options_(std::move(options)), driver_(driver), tap_(tap) {
  if (!options_.configuration) return;
  configuration_.emplace(*options_.configuration, static_cast<xsens::MtLine&>(*this));
  driver_.set_observer(&*configuration_);
}

SerialSource::~SerialSource() {
  if (configuration_) driver_.set_observer(nullptr);
}

void SerialSource::receive(Duration wait) noexcept {
  const auto now = live::Steady::now();
  if (!port_.is_open() && pause_.take(now)) open();
  if (!port_.is_open()) {
    const std::timespec pause = live::to_timespec(pause_.left(now, wait));
    ::clock_nanosleep(CLOCK_MONOTONIC, 0, &pause, nullptr);
    return;
  }
  if (configuration_) {
    wait = std::min<Duration>(wait, std::max<Duration>(configuration_->next_due() - now, {}));
  }
  wait_for_input(wait);
  if (configuration_ && port_.is_open()) configuration_->update(live::Steady::now());
  if (line_error_ != 0 && port_.is_open()) lose(line_error_);
}

void SerialSource::open() noexcept {
  const std::uint32_t baud = configuration_ ? configuration_->baud() : options_.baud;
  const int error = port_.open(options_.device, baud);
  if (error != 0) return status_.set(live::LinkState::closed, error);
  line_error_ = 0;
  counters_.opened.add();
  low_latency_.store(port_.low_latency(), std::memory_order_relaxed);
  status_.set_open();
  if (configuration_) configuration_->begin(live::Steady::now());
}

void SerialSource::lose(int error) noexcept {
  port_.close();
  if (configuration_) configuration_->end();
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
  if (configuration_) configuration_->update(live::Steady::now());
  driver_.on_bytes(bytes, stamp);
}

void SerialSource::send(wire::Bytes frame) noexcept {
  const int error = port_.write(frame);
  // A line that is full now takes the repetition.
  if (error != 0 && error != EAGAIN && error != EINTR) line_error_ = error;
}

bool SerialSource::set_baud(std::uint32_t baud) noexcept {
  driver_.set_baud(baud);
  return port_.set_baud(baud) == 0;
}

}  // namespace convexcut::serial
