// SPDX-License-Identifier: Apache-2.0
//
// Cuts a lidar's firings into scans.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "core/angle.hpp"
#include "core/counter.hpp"
#include "core/return_batch.hpp"
#include "core/scan/function_ref.hpp"
#include "core/scan/rotor_tracker.hpp"
#include "core/scan/scan.hpp"
#include "core/time.hpp"

namespace convexcut {

struct CutOptions {
  enum class Mode : std::uint8_t {
    revolution,  // from one passage of cut_azimuth to the next
    clock,       // windows of LidarTime, aligned to its multiples of `window`
  };
  // What a dual-return firing gives to the scan. Single returns are always taken.
  enum class Echoes : std::uint8_t {
    farthest,   // of the two; structure is what lies behind
    last,       // as the sensor tags it
    strongest,  // as the sensor tags it: the second strongest where the last is the strongest
    both,
  };
  Mode mode = Mode::revolution;
  Azimuth cut_azimuth;
  Duration window = std::chrono::milliseconds{100};   // clock mode, 1 ns … 4 s
  Duration timeout = std::chrono::milliseconds{300};  // revolution mode, 1 ns … 4 s
  double min_range_m = 0.0;                           // both bounds are included
  double max_range_m = 1000.0;
  Echoes echoes = Echoes::farthest;
};

struct CutterCounters {
  Counter stale_batches;     // dropped: not later than one before
  Counter azimuth_glitches;  // firings that were cut by the expected azimuth, not by their own
};

// Gives `scan` the capacity that a ScanCutter fills: call it on every scan that is swapped in.
void reserve(Scan& scan, std::size_t max_returns, std::size_t max_firings);

// A firing (all lasers once) belongs to the scan that the azimuth (or time) of its first laser is
// in; every firing that is pushed is in exactly one scan, in order. A scan ends with the first
// firing at or past the cut, and never again for that passage, however the encoder jitters. When no
// cut came for `timeout` the scan ends too, with a whole new one after it. See
// docs/design/scan_cutting.md.
//
// Batches come in the order of time (PacketSequencer). A batch up to `timeout` older than the last
// is dropped and counted; an older one means that the source has restarted: the scan ends.
//
// One thread; the counters may be read by any. RT after construction: no allocation, no lock, no
// system call.
class ScanCutter {
 public:
  // Called at the end of a scan. May swap the scan with another that has been reserve()d: its
  // contents are dropped, its capacity is what the next scan can hold.
  using OnScan = FunctionRef<void(Scan&)>;

  // What a scan has beyond the maxima is dropped and counted in Scan::overflow_returns. Throws
  // std::invalid_argument when an option is out of its range.
  ScanCutter(const CutOptions& options, std::size_t max_returns_per_scan, std::size_t max_firings);

  // `first_firing`: the unwrapped batch.first_firing.
  void push(const ReturnBatch& batch, LidarTime first_firing, OnScan on_scan) noexcept;

  // Ends the scan that is open, if any (ScanEnd::end_of_input), and forgets the rotor.
  void finish(OnScan on_scan) noexcept;

  [[nodiscard]] const CutterCounters& counters() const noexcept { return counters_; }

 private:
  void begin(LidarTime first_firing, std::int64_t sector) noexcept;
  void end(ScanEnd why, OnScan on_scan) noexcept;
  // Revolution: turns past the cut azimuth. Clock: windows since the epoch of LidarTime.
  [[nodiscard]] std::int64_t sector_of(const Firing& firing, LidarTime time) noexcept;
  // all: selects_all(batch).
  void add(const ReturnBatch& batch, const Firing& firing, LidarTime time, bool all) noexcept;
  // Adds the batch's returns [begin, end), of which `room` have a place.
  void add_run(const ReturnBatch& batch, std::size_t begin, std::size_t end,
               std::size_t room) noexcept;
  // Copies the run that is still to be.
  void copy_run(const ReturnBatch& batch) noexcept;
  [[nodiscard]] bool selects(const ReturnBatch& batch, std::size_t i) const noexcept;
  [[nodiscard]] bool selects_all(const ReturnBatch& batch) const noexcept;
  // With the run that is still to be copied.
  [[nodiscard]] std::size_t returns() const noexcept {
    return scan_.size() + (run_end_ - run_begin_);
  }
  void measure_rotor() noexcept;

  CutOptions options_;
  float min_range_m_;
  float max_range_m_;

  Scan scan_;
  bool open_ = false;
  std::size_t max_returns_ = 0;  // of scan_, which may have been swapped for a smaller one
  std::size_t max_firings_ = 0;
  std::uint64_t next_index_ = 0;
  std::int64_t sector_ = 0;  // of the open scan
  Sweep sweep_at_begin_;     // of it
  // Returns of the batch at hand that are in the open scan and not yet copied: firings follow each
  // other, and a batch is mostly one run.
  std::size_t run_begin_ = 0;
  std::size_t run_end_ = 0;

  bool started_ = false;
  LidarTime batch_time_{};    // first firing of the newest batch
  LidarTime firing_time_{};   // of the newest firing
  Duration firing_period_{};  // of the newest batch
  RotorTracker rotor_;
  CutterCounters counters_;
};

}  // namespace convexcut
