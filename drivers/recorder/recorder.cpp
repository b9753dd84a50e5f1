// SPDX-License-Identifier: Apache-2.0
#include "drivers/recorder/recorder.hpp"

#include <stdexcept>
#include <utility>

#include <pthread.h>

namespace convexcut::recorder {
namespace {

// For as long as a disk may be busy: 7 s of a single-return HDL-32E, 3.5 s of a dual-return one …
constexpr std::size_t kLidarRing = 16U << 20U;
// … and much longer of the others.
constexpr std::size_t kOtherRing = 1U << 20U;

constexpr auto kDrainEvery = std::chrono::milliseconds{50};
constexpr auto kMaintainEvery = std::chrono::seconds{1};

}  // namespace

Recorder::Recorder(RecorderOptions options, Say say)
    : options_(std::move(options)),
      say_(std::move(say)),
      files_(options_.files),
      rings_{std::make_unique<RecordRing>(kLidarRing), std::make_unique<RecordRing>(kOtherRing),
             std::make_unique<RecordRing>(kOtherRing)} {
  thread_ = std::thread([this] { run(); });
  static_cast<void>(::pthread_setname_np(thread_.native_handle(), "record"));
}

void Recorder::finish() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

std::uint64_t Recorder::missing() const noexcept {
  std::uint64_t count = counters_.unwritten.value() + counters_.refused.value();
  for (const auto& ring : rings_) count += ring->overruns();
  return count;
}

void Recorder::run() {
  bool ending = false;
  while (!ending) {
    {
      std::unique_lock lock(mutex_);
      ending = wake_.wait_for(lock, kDrainEvery, [this] { return ending_; });
    }
    step(std::chrono::steady_clock::now());
  }
  try {
    files_.close();
    count_flushed();
  } catch (const capture::CaptureError& error) {
    stop(error.what(), {});
  }
}

void Recorder::step(SteadyTime now) {
  if (!is_recording() && now >= retry_at_) {
    recording_.store(true, std::memory_order_relaxed);  // pairs with is_recording()
  }
  try {
    if (!is_recording()) return drop_all();
    if (told_stopped_) files_.maintain(now);  // before a file is made: is there room at all?
    drain(now);
    if (now < maintain_at_ && !told_stopped_) return;
    maintain_at_ = now + kMaintainEvery;
    files_.maintain(now);
    count_flushed();
    if (told_stopped_) tell_goes_on();
  } catch (const capture::CaptureError& error) {
    stop(error.what(), now);
  }
}

void Recorder::drain(SteadyTime now) {
  for (std::size_t i = 0; i < kStreams; ++i) {
    capture::Record record;
    while (rings_[i]->front(record)) {
      write(static_cast<Stream>(i), record, now);
      rings_[i]->pop();
    }
  }
}

void Recorder::write(Stream stream, const capture::Record& record, SteadyTime now) {
  try {
    files_.write(stream, record, now);
    ++unflushed_;
  } catch (const std::invalid_argument&) {
    counters_.refused.add();
  }
}

void Recorder::count_flushed() noexcept {
  counters_.records.add(std::exchange(unflushed_, 0));
  counters_.bytes.add(files_.bytes() - counters_.bytes.value());
}

void Recorder::drop_all() noexcept {
  for (const auto& ring : rings_) {
    capture::Record record;
    while (ring->front(record)) {
      counters_.unwritten.add();
      ring->pop();
    }
  }
}

void Recorder::stop(const std::string& reason, SteadyTime now) {
  files_.abandon();
  recording_.store(false, std::memory_order_relaxed);  // pairs with is_recording()
  retry_at_ = now + options_.retry_after;
  counters_.stops.add();
  counters_.unwritten.add(std::exchange(unflushed_, 0));
  if (std::exchange(told_stopped_, true)) return;
  say_(true,
       reason + "; recording is stopped, the rest goes on; it is tried again every " +
           std::to_string(
               std::chrono::duration_cast<std::chrono::seconds>(options_.retry_after).count()) +
           " s");
}

void Recorder::tell_goes_on() {
  told_stopped_ = false;
  say_(false, "recording goes on in segment " + std::to_string(files_.segment()) + "; " +
                  std::to_string(missing()) + " records are missing so far");
}

}  // namespace convexcut::recorder
