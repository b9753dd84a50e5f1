// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/worker_team.hpp"

#include <algorithm>

#include "core/convex_cut/spin.hpp"

namespace convexcut {

WorkerTeam::WorkerTeam(unsigned members) {
  if (members < 2) return;
  members = std::min(members, kMostMembers);
  threads_.reserve(members - 1);
  try {
    for (unsigned member = 1; member < members; ++member) {
      threads_.emplace_back([this, member] { serve(member); });
    }
  } catch (...) {
    stop();
    throw;
  }
}

WorkerTeam::~WorkerTeam() { stop(); }

void WorkerTeam::run(Task task) noexcept {
  task_ = task;
  if (!threads_.empty()) {
    left_.store(0, std::memory_order_relaxed);
    open();
  }
  task.call(task.context, 0);
  if (threads_.empty()) return;
  // Nobody enters from here on: the task may change. Relaxed: what those who entered wrote comes
  // with left_.
  const std::uint32_t entered = gate_.fetch_or(kClosed, std::memory_order_relaxed) % kClosed;
  // Acquire: pairs with the release in serve(); all that the work wrote is visible from here on.
  wait_until(left_, [entered](std::uint32_t left) { return left == entered; });
}

void WorkerTeam::open() noexcept {
  const std::uint32_t round = gate_.load(std::memory_order_relaxed) / kRound + 1;
  // Release: pairs with the acquire in enter(); publishes task_, left_, stopping_ and all that the
  // work reads.
  gate_.store(round * kRound, std::memory_order_release);
  gate_.notify_all();
}

// Waits for another round than the one that was seen last. False when it has been closed already.
bool WorkerTeam::enter(std::uint32_t& seen_round) noexcept {
  // Acquire, here and below: pairs with the release in open().
  std::uint32_t gate =
      wait_until(gate_, [seen_round](std::uint32_t now) { return now / kRound != seen_round; });
  bool has_entered = false;
  while (gate % kRound < kClosed && !has_entered) {
    has_entered = gate_.compare_exchange_weak(gate, gate + 1, std::memory_order_acquire,
                                              std::memory_order_acquire);
  }
  seen_round = gate / kRound;
  return has_entered;
}

void WorkerTeam::serve(unsigned member) noexcept {
  for (std::uint32_t seen_round = 0;;) {
    if (!enter(seen_round)) continue;
    if (stopping_) return;
    task_.call(task_.context, member);
    // Release: pairs with the acquire in run().
    left_.fetch_add(1, std::memory_order_release);
    left_.notify_one();
  }
}

// Its round is not closed: every thread comes to it.
void WorkerTeam::stop() noexcept {
  stopping_ = true;
  open();
  for (std::thread& thread : threads_) thread.join();
}

}  // namespace convexcut
