// SPDX-License-Identifier: Apache-2.0
//
// One step of a piece of work that a WorkerTeam shares: items that any thread takes.
#pragma once

#include <atomic>
#include <cstdint>

#include <hwy/cache_control.h>

#include "core/convex_cut/spin.hpp"

namespace convexcut {

class SharedStep {
 public:
  // Before the team sets to work. of_front: as many of the items are in the caches of those who
  // take them from the front, where there are others, who have the rest in theirs.
  void prepare(std::uint32_t items) noexcept { prepare(items, kNobodys); }
  void prepare(std::uint32_t items, std::uint32_t of_front) noexcept {
    items_ = items;
    of_front_ = of_front;
    taken_.store(0, std::memory_order_relaxed);  // published by the team
    done_.store(0, std::memory_order_relaxed);
  }

  // Calls work(item) for items that no other thread has taken, until none is left, and returns when
  // all have been done. Members with even numbers take them from the front, the others from the
  // back: from step to step and from cloud to cloud a thread meets what it has in its own cache.
  // What was written by an item is visible after. A thread that comes late finds the items taken:
  // nobody waits long for one that has not come yet. RT: no allocation, no lock; a system call only
  // when other threads take long over their last items.
  template <class Work>
  void run(unsigned member, Work&& work) noexcept {
    const bool from_the_back = member % 2 != 0;
    const std::uint64_t one = from_the_back ? kOneFromTheBack : 1;
    const std::uint32_t own_items = from_the_back ? items_ - of_front_ : of_front_;
    std::uint32_t done_here = 0;
    bool has_waited = of_front_ == kNobodys;
    for (std::uint32_t next = 0;;) {
      if (!has_waited && next >= own_items) {
        has_waited = true;
        if (others_finish(from_the_back, done_here)) return;
        done_here = 0;
      }
      // Relaxed: the counts only deal the items out.
      const std::uint64_t taken = taken_.fetch_add(one, std::memory_order_relaxed);
      const auto front = static_cast<std::uint32_t>(taken);
      const auto back = static_cast<std::uint32_t>(taken / kOneFromTheBack);
      if (front + back >= items_) break;
      work(from_the_back ? items_ - 1 - back : front);
      ++done_here;
      next = (from_the_back ? back : front) + 1;
    }
    if (has_done(done_here)) return;
    wait_until(done_, [this](std::uint32_t done) { return done >= items_; });
  }

 private:
  static constexpr std::uint32_t kNobodys = 0xFFFF'FFFF;

  // Whether these were the last ones.
  bool has_done(std::uint32_t items) noexcept {
    // Release: pairs with the acquire in run() and others_finish(), in every thread of the team.
    if (items == 0 || done_.fetch_add(items, std::memory_order_acq_rel) + items != items_) {
      return false;
    }
    done_.notify_all();
    return true;
  }

  // Taking an item out of another thread's cache takes longer than it does there: so those who are
  // through with theirs leave the others some time, and more when they have begun.
  bool others_finish(bool from_the_back, std::uint32_t done_here) noexcept {
    constexpr int kSpinsToBegin = 200;
    constexpr int kSpins = 1500;
    if (has_done(done_here)) return true;
    for (int spin = 0; spin < kSpins; ++spin) {
      // Acquire: pairs with the release in has_done().
      if (done_.load(std::memory_order_acquire) >= items_) return true;
      if (spin == kSpinsToBegin) {
        // Relaxed: a guess.
        const std::uint64_t taken = taken_.load(std::memory_order_relaxed);
        if ((from_the_back ? taken % kOneFromTheBack : taken / kOneFromTheBack) == 0) return false;
      }
      hwy::Pause();
    }
    return false;
  }

  // Apart, so that waiting does not disturb dealing.
  static constexpr std::uint64_t kOneFromTheBack = std::uint64_t{1} << 32U;
  alignas(64) std::atomic<std::uint64_t> taken_{0};  // items from the front; from the back
  alignas(64) std::atomic<std::uint32_t> done_{0};   // items that have been done
  std::uint32_t items_ = 0;                          // written by prepare() only, as the next
  std::uint32_t of_front_ = kNobodys;
};

}  // namespace convexcut
