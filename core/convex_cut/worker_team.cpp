// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/worker_team.hpp"

#include "core/convex_cut/spin.hpp"

namespace convexcut {

WorkerTeam::WorkerTeam(unsigned members) {
  if (members < 2) return;
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
    busy_.store(static_cast<std::uint32_t>(threads_.size()), std::memory_order_relaxed);
    // Release: pairs with the acquire in serve(); publishes the task, busy_ and all that the work
    // reads.
    round_.fetch_add(1, std::memory_order_release);
    round_.notify_all();
  }
  task.call(task.context, 0);
  // Acquire: pairs with the release in serve(); all that the work wrote is visible from here on.
  wait_until(busy_, [](std::uint32_t busy) { return busy == 0; });
}

void WorkerTeam::serve(unsigned member) noexcept {
  for (std::uint32_t seen = 0;;) {
    // Pairs with the release in run() and stop().
    wait_until(round_, [seen](std::uint32_t round) { return round != seen; });
    ++seen;  // no round can be missed: the next one waits for this thread
    if (stopping_) return;
    task_.call(task_.context, member);
    // Release: pairs with the acquire in run().
    if (busy_.fetch_sub(1, std::memory_order_release) == 1) busy_.notify_one();
  }
}

void WorkerTeam::stop() noexcept {
  stopping_ = true;
  round_.fetch_add(1, std::memory_order_release);  // publishes stopping_
  round_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

}  // namespace convexcut
