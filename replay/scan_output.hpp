// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>

#include "core/scan/scan.hpp"
#include "replay/scan_writer.hpp"

namespace convexcut::replay {

// Writes scans on a thread of its own, in order, while the next ones are being computed. At most
// kSlots scans exist at a time, so memory does not grow with the recording. What the writer throws
// comes out of the next call.
class ScanOutput {
 public:
  // max_points: of a scan.
  ScanOutput(ScanWriter& writer, std::size_t max_points);
  ScanOutput(const ScanOutput&) = delete;
  ScanOutput& operator=(const ScanOutput&) = delete;
  ~ScanOutput();

  // A scan to fill; waits until one is free. The same one until submit().
  [[nodiscard]] LevelledScan& slot();
  // Has the filled slot written.
  void submit(Duration latency);
  // Waits until everything is written.
  void finish();

 private:
  static constexpr std::size_t kSlots = 3;

  struct Slot {
    LevelledScan scan;
    Duration latency{};
  };

  void run() noexcept;
  void join() noexcept;

  ScanWriter& writer_;
  std::array<Slot, kSlots> slots_;
  std::mutex mutex_;  // guards the four below
  std::condition_variable changed_;
  std::size_t submitted_ = 0;
  std::size_t written_ = 0;
  bool closed_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace convexcut::replay
