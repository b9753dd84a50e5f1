// SPDX-License-Identifier: Apache-2.0
//
// Records live sources as they come, so that the recording can be replayed: taps for the receive
// threads, and a thread that writes. Design note: docs/design/recording.md.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/counter.hpp"
#include "drivers/live/raw_tap.hpp"
#include "drivers/recorder/record_ring.hpp"
#include "drivers/recorder/recording_files.hpp"

namespace convexcut::recorder {

struct RecorderOptions {
  RecordingOptions files;
  // After a failure (disk full), this long until recording is tried again.
  Duration retry_after = std::chrono::seconds{10};
};

// What became of the records; readable from any thread.
struct RecorderCounters {
  Counter records;    // that are on the disk
  Counter bytes;      // of the files, headers included
  Counter unwritten;  // dropped while recording was stopped, or not on the disk when it was
  Counter refused;    // that no capture can hold: datagrams without addresses, impossible stamps
  Counter stops;      // times that recording was stopped by a failure
};

// A failure never reaches the daemon: recording stops, says so once, counts what is missing, and
// goes on in a new segment when it can.
class Recorder {
 public:
  // One line for people, on the recorder's own thread; `problem`: something is wrong, else it is
  // well again.
  using Say = std::function<void(bool problem, const std::string& line)>;

  // Makes the directory and starts the thread. Throws capture::CaptureError.
  Recorder(RecorderOptions options, Say say);
  ~Recorder() { finish(); }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // For the receive thread of that source, and only for it.
  [[nodiscard]] live::RawTap& tap(Stream stream) noexcept {
    return *rings_[static_cast<std::size_t>(stream)];
  }

  // Writes what is there, and ends. The receive threads have ended before.
  void finish();

  // Any thread.
  [[nodiscard]] const RecorderCounters& counters() const noexcept { return counters_; }
  // What is not in the recording, for whatever reason.
  [[nodiscard]] std::uint64_t missing() const noexcept;
  [[nodiscard]] bool is_recording() const noexcept {
    return recording_.load(std::memory_order_relaxed);  // a value on its own: orders nothing
  }

 private:
  using SteadyTime = RecordingFiles::SteadyTime;

  void run();
  void step(SteadyTime now);
  void drain(SteadyTime now);
  void write(Stream stream, const capture::Record& record, SteadyTime now);
  void count_flushed() noexcept;
  void drop_all() noexcept;
  void stop(const std::string& reason, SteadyTime now);
  void tell_goes_on();

  RecorderOptions options_;
  Say say_;
  RecordingFiles files_;
  std::array<std::unique_ptr<RecordRing>, kStreams> rings_;
  RecorderCounters counters_;
  std::atomic<bool> recording_{true};  // pairs with is_recording()
  // The writing thread only.
  std::uint64_t unflushed_ = 0;  // records
  bool told_stopped_ = false;    // between a failure and the next success
  SteadyTime retry_at_{};
  SteadyTime maintain_at_{};

  std::mutex mutex_;
  std::condition_variable wake_;
  bool ending_ = false;  // under mutex_
  std::thread thread_;
};

}  // namespace convexcut::recorder
