// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/worker_team.hpp"

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
  for (std::uint32_t busy = busy_.load(std::memory_order_acquire); busy != 0;
       busy = busy_.load(std::memory_order_acquire)) {
    busy_.wait(busy, std::memory_order_acquire);
  }
}

void WorkerTeam::serve(unsigned member) noexcept {
  for (std::uint32_t seen = 0;;) {
    round_.wait(seen, std::memory_order_acquire);  // pairs with the release in run() and stop()
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
