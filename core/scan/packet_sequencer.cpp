// SPDX-License-Identifier: Apache-2.0
#include "core/scan/packet_sequencer.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace convexcut {
namespace {

constexpr std::size_t kMaxWindow = 32;
constexpr Duration kResync = std::chrono::seconds{1};
constexpr std::int64_t kRemembered = 64;  // bits of passed_
// No reordering makes so many: the sensor's clock was set back a little.
constexpr std::uint32_t kRefusedIsResync = 64;

}  // namespace

PacketSequencer::PacketSequencer(std::size_t window) : slots_(window), held_(window) {
  if (window < 1 || window > kMaxWindow) {
    throw std::invalid_argument("the window of a packet sequencer is 1 to 32");
  }
  for (std::size_t i = 0; i < window; ++i) held_[i].slot = i;
}

void PacketSequencer::push(const ReturnBatch& batch, LidarTime first_firing, Emit emit) noexcept {
  if (batch.span() <= Duration::zero()) return;
  if (!started_) return start(batch, first_firing, emit);

  const Duration ahead = first_firing - last_;
  const std::int64_t turn = place(first_firing);
  const bool set_back = turn <= 0 && refused_in_a_row_ >= kRefusedIsResync;
  if (ahead > kResync || ahead < -kResync || set_back) {
    flush(emit);
    counters_.resyncs.add();
    return start(batch, first_firing, emit);
  }
  if (turn <= 0) return refuse_passed(turn);
  refused_in_a_row_ = 0;
  if (turn == 1) {
    if (held_count_ > 0) counters_.reordered.add();
    pass(batch, first_firing, emit);
    return pass_held_in_turn(emit);
  }
  if (is_held(turn)) return counters_.duplicates.add();
  if (held_count_ == slots_.size()) {
    // What is missing before the earliest is given up; the earliest may be the one in hand.
    if (first_firing < held_[0].first_firing) {
      counters_.reordered.add();
      pass(batch, first_firing, emit);
      return pass_held_in_turn(emit);
    }
    pass_first_held(emit);
    pass_held_in_turn(emit);
    if (place(first_firing) == 1) {
      pass(batch, first_firing, emit);
      return pass_held_in_turn(emit);
    }
  }
  hold(batch, first_firing);
}

void PacketSequencer::flush(Emit emit) noexcept {
  while (held_count_ > 0) pass_first_held(emit);
}

std::int64_t PacketSequencer::place(LidarTime first_firing) const noexcept {
  const Duration::rep ahead = (first_firing - last_).count();
  const Duration::rep half = span_.count() / 2;
  return (ahead + (ahead < 0 ? -half : half)) / span_.count();
}

void PacketSequencer::start(const ReturnBatch& batch, LidarTime first_firing, Emit emit) noexcept {
  started_ = true;
  passed_ = 1;
  refused_in_a_row_ = 0;
  last_ = first_firing;
  span_ = batch.span();
  emit(batch, first_firing);
}

void PacketSequencer::pass(const ReturnBatch& batch, LidarTime first_firing, Emit emit) noexcept {
  const std::int64_t turn = std::max<std::int64_t>(place(first_firing), 1);
  counters_.lost.add(static_cast<std::uint64_t>(turn - 1));
  passed_ = turn < kRemembered ? (passed_ << static_cast<unsigned>(turn)) | 1U : 1U;
  last_ = first_firing;
  span_ = batch.span();
  emit(batch, first_firing);
}

void PacketSequencer::pass_first_held(Emit emit) noexcept {
  const Held first = held_[0];
  const auto begin = held_.begin();
  std::rotate(begin, begin + 1, begin + static_cast<std::ptrdiff_t>(held_count_));
  --held_count_;
  pass(slots_[first.slot], first.first_firing, emit);
}

void PacketSequencer::pass_held_in_turn(Emit emit) noexcept {
  while (held_count_ > 0 && place(held_[0].first_firing) <= 1) pass_first_held(emit);
}

void PacketSequencer::refuse_passed(std::int64_t place) noexcept {
  ++refused_in_a_row_;
  const std::int64_t back = -place;
  const bool was_passed =
      back < kRemembered && ((passed_ >> static_cast<unsigned>(back)) & 1U) != 0;
  (was_passed ? counters_.duplicates : counters_.late).add();
}

bool PacketSequencer::is_held(std::int64_t turn) const noexcept {
  return std::any_of(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(held_count_),
                     [&](const Held& held) { return place(held.first_firing) == turn; });
}

void PacketSequencer::hold(const ReturnBatch& batch, LidarTime first_firing) noexcept {
  std::size_t at = held_count_;
  while (at > 0 && held_[at - 1].first_firing > first_firing) --at;
  if (at < held_count_) counters_.reordered.add();
  slots_[held_[held_count_].slot] = batch;
  held_[held_count_].first_firing = first_firing;
  const auto begin = held_.begin();
  std::rotate(begin + static_cast<std::ptrdiff_t>(at),
              begin + static_cast<std::ptrdiff_t>(held_count_),
              begin + static_cast<std::ptrdiff_t>(held_count_) + 1);
  ++held_count_;
}

}  // namespace convexcut
