// SPDX-License-Identifier: Apache-2.0
//
// A few threads that wait for a piece of parallel work, together with the thread that has it.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace convexcut {

class WorkerTeam {
 public:
  // Starts members − 1 threads (none for 0 and 1; at most 1023). They inherit the scheduling policy
  // and the affinity of the calling thread. Throws std::system_error when one cannot be started.
  explicit WorkerTeam(unsigned members);
  ~WorkerTeam();
  WorkerTeam(const WorkerTeam&) = delete;
  WorkerTeam& operator=(const WorkerTeam&) = delete;

  [[nodiscard]] unsigned size() const noexcept {
    return static_cast<unsigned>(threads_.size()) + 1;
  }

  // Calls work(member) in the calling thread with member 0, and at most once in each other thread
  // of the team that comes before that has returned; returns when all that have come have returned.
  // So a thread that gets no processor delays nobody. What was written before is visible in the
  // work, and what the work wrote is visible after. One caller at a time. RT: no allocation and no
  // lock; members sleep in a futex between calls.
  template <class Work>
  void run(Work& work) noexcept {
    run({[](void* context, unsigned member) noexcept { (*static_cast<Work*>(context))(member); },
         &work});
  }

 private:
  struct Task {
    void (*call)(void* context, unsigned member) noexcept = nullptr;
    void* context = nullptr;
  };
  void run(Task task) noexcept;
  void serve(unsigned member) noexcept;
  void stop() noexcept;

  // The gate's value: how many threads have entered the round, whether it is closed, its number.
  static constexpr std::uint32_t kClosed = 0x400;
  static constexpr std::uint32_t kRound = 2 * kClosed;
  static constexpr unsigned kMostMembers = kClosed;  // the caller does not enter
  void open() noexcept;
  [[nodiscard]] bool enter(std::uint32_t& seen_round) noexcept;

  Task task_;              // written while the gate is closed and nobody is inside
  bool stopping_ = false;  // likewise
  std::atomic<std::uint32_t> gate_{kClosed};
  std::atomic<std::uint32_t> left_{0};  // threads that entered the round and have finished it
  std::vector<std::thread> threads_;
};

}  // namespace convexcut
