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
    next_.store(0, std::memory_order_relaxed);  // published by the team
    done_.store(0, std::memory_order_relaxed);
  }

  // Calls work(item) for items that no other thread has taken, until none is left, and returns when
  // all have been done. What was written by an item is visible after. A thread that comes late
  // finds the items taken: nobody waits for one that has not come yet. RT: no allocation, no lock;
  // a system call only when other threads take long over their last items.
  template <class Work>
  void run(Work&& work) noexcept {
    std::uint32_t done_here = 0;
    // Relaxed: the counter only deals the items out.
    for (std::uint32_t item = next_.fetch_add(1, std::memory_order_relaxed); item < items_;
         item = next_.fetch_add(1, std::memory_order_relaxed)) {
      work(item);
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
  std::uint32_t items_ = 0;  // written by prepare() only
  // Apart, so that waiting does not disturb dealing.
  alignas(64) std::atomic<std::uint32_t> next_{0};  // item that is taken next
  alignas(64) std::atomic<std::uint32_t> done_{0};  // items that have been done
};

}  // namespace convexcut
