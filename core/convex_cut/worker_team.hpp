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
  // Starts members − 1 threads (none for 0 and 1). They inherit the scheduling policy and the
  // affinity of the calling thread. Throws std::system_error when one cannot be started.
  explicit WorkerTeam(unsigned members);
  ~WorkerTeam();
  WorkerTeam(const WorkerTeam&) = delete;
  WorkerTeam& operator=(const WorkerTeam&) = delete;

  [[nodiscard]] unsigned size() const noexcept {
    return static_cast<unsigned>(threads_.size()) + 1;
  }

  // Calls work(member) once in every thread of the team, in the calling one with member 0, and
  // returns when all have returned. What was written before is visible in the work, and what the
  // work wrote is visible after. One caller at a time. RT: no allocation and no lock; members
  // sleep in a futex between calls.
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

  Task task_;                            // written between rounds only
  std::atomic<std::uint32_t> round_{0};  // grows by one for each piece of work
  std::atomic<std::uint32_t> busy_{0};   // threads that have not finished the round
  bool stopping_ = false;                // written between rounds only
  std::vector<std::thread> threads_;
};

}  // namespace convexcut
