// SPDX-License-Identifier: Apache-2.0
//
// One step of a piece of work that a WorkerTeam shares: items that any thread takes.
#pragma once

#include <atomic>
#include <cstdint>

#include "core/convex_cut/spin.hpp"

namespace convexcut {

class SharedStep {
 public:
  // Before the team sets to work.
  void prepare(std::uint32_t items) noexcept {
    items_ = items;
    taken_.store(0, std::memory_order_relaxed);  // published by the team
    done_.store(0, std::memory_order_relaxed);
  }

  // Calls work(item) for items that no other thread has taken, until none is left, and returns when
  // all have been done. Members with even numbers take them from the front, the others from the
  // back: from step to step and from cloud to cloud a thread meets what it has in its own cache.
  // What was written by an item is visible after. A thread that comes late finds the items taken:
  // nobody waits for one that has not come yet. RT: no allocation, no lock; a system call only when
  // other threads take long over their last items.
  template <class Work>
  void run(unsigned member, Work&& work) noexcept {
    const bool from_the_back = member % 2 != 0;
    const std::uint64_t one = from_the_back ? kOneFromTheBack : 1;
    std::uint32_t done_here = 0;
    for (;;) {
      // Relaxed: the counts only deal the items out.
      const std::uint64_t taken = taken_.fetch_add(one, std::memory_order_relaxed);
      const auto front = static_cast<std::uint32_t>(taken);
      const auto back = static_cast<std::uint32_t>(taken / kOneFromTheBack);
      if (front + back >= items_) break;
      work(from_the_back ? items_ - 1 - back : front);
      ++done_here;
    }
    // Release: pairs with the acquire below, in every thread of the team.
    if (done_here > 0 &&
        done_.fetch_add(done_here, std::memory_order_acq_rel) + done_here == items_) {
      done_.notify_all();
      return;
    }
    wait_until(done_, [this](std::uint32_t done) { return done >= items_; });
  }

 private:
  // Apart, so that waiting does not disturb dealing.
  static constexpr std::uint64_t kOneFromTheBack = std::uint64_t{1} << 32U;
  alignas(64) std::atomic<std::uint64_t> taken_{0};  // items from the front; from the back
  alignas(64) std::atomic<std::uint32_t> done_{0};   // items that have been done
  std::uint32_t items_ = 0;                          // written by prepare() only
};

}  // namespace convexcut
