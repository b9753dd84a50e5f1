// SPDX-License-Identifier: Apache-2.0
//
// Puts a lidar's datagrams back into the order in which the sensor sent them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/counter.hpp"
#include "core/return_batch.hpp"
#include "core/scan/function_ref.hpp"
#include "core/time.hpp"

namespace convexcut {

struct SequencerCounters {
  Counter duplicates;  // dropped: the same sensor time came before
  Counter reordered;   // came after a later one, and were put back into place
  Counter late;        // dropped: their place had been given up (they are among the lost)
  Counter lost;        // places given up, from the sensor's clock
  Counter resyncs;     // the sensor's time went back, or more than a second ahead
};

// Datagrams follow each other by their span (552.96 µs, stamped 552 or 553 µs apart). One that
// follows the last is passed on at once and uncopied. One that comes ahead of its turn is held
// (copied) until the missing ones come, or until more than `window` are held: then the missing ones
// are given up. After the last datagram of a stream, or when none comes for a while, flush().
//
// One writing thread; the counters may be read by any. RT after construction: no allocation, no
// lock, no system call.
class PacketSequencer {
 public:
  using Emit = FunctionRef<void(const ReturnBatch&, LidarTime first_firing)>;

  // `window`: by how many datagrams one may be overtaken, 1 … 32. Throws std::invalid_argument.
  explicit PacketSequencer(std::size_t window = 4);

  // `first_firing`: the unwrapped batch.first_firing. Batches without firings are ignored.
  void push(const ReturnBatch& batch, LidarTime first_firing, Emit emit) noexcept;
  // Passes on what is held; the gaps in it are lost.
  void flush(Emit emit) noexcept;

  [[nodiscard]] const SequencerCounters& counters() const noexcept { return counters_; }

 private:
  struct Held {
    LidarTime first_firing{};
    std::size_t slot = 0;
  };

  // How many places after the last one passed on: 1 is next, 0 and below have passed.
  [[nodiscard]] std::int64_t place(LidarTime first_firing) const noexcept;
  void start(const ReturnBatch& batch, LidarTime first_firing, Emit emit) noexcept;
  void pass(const ReturnBatch& batch, LidarTime first_firing, Emit emit) noexcept;
  void pass_first_held(Emit emit) noexcept;
  void pass_held_in_turn(Emit emit) noexcept;
  void refuse_passed(std::int64_t place) noexcept;
  [[nodiscard]] bool is_held(std::int64_t turn) const noexcept;
  void hold(const ReturnBatch& batch, LidarTime first_firing) noexcept;

  std::vector<ReturnBatch> slots_;
  std::vector<Held> held_;  // of capacity slots_, in the order of time; the slots behind are free
  std::size_t held_count_ = 0;

  bool started_ = false;
  LidarTime last_{};
  Duration span_{};
  std::uint64_t passed_ = 0;  // bit k: the datagram k places before the last one was passed on
  std::uint32_t refused_in_a_row_ = 0;
  SequencerCounters counters_;
};

}  // namespace convexcut
