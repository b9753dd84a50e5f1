// SPDX-License-Identifier: Apache-2.0
#include "replay/scan_output.hpp"

#include <utility>

#include "core/scan/levelling.hpp"

namespace convexcut::replay {

ScanOutput::ScanOutput(ScanWriter& writer, std::size_t max_points) : writer_(writer) {
  for (Slot& slot : slots_) reserve(slot.scan, max_points);
  thread_ = std::thread([this] { run(); });
}

ScanOutput::~ScanOutput() { join(); }

LevelledScan& ScanOutput::slot() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return failure_ || submitted_ - written_ < kSlots; });
  if (failure_) std::rethrow_exception(failure_);
  return slots_[submitted_ % kSlots].scan;
}

void ScanOutput::submit(Duration latency) {
  const std::lock_guard lock(mutex_);
  slots_[submitted_ % kSlots].latency = latency;
  ++submitted_;
  changed_.notify_all();
}

void ScanOutput::finish() {
  join();
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void ScanOutput::join() noexcept {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

void ScanOutput::run() noexcept {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return closed_ || written_ < submitted_; });
    if (written_ == submitted_) return;
    const Slot& slot = slots_[written_ % kSlots];
    lock.unlock();
    std::exception_ptr failure;
    try {
      writer_.write(slot.scan, slot.latency);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    ++written_;
    if (failure) failure_ = failure;
    changed_.notify_all();
    if (failure_) return;
  }
}

}  // namespace convexcut::replay
