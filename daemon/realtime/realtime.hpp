// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <sched.h>

#include "config/config.hpp"
#include "daemon/realtime/thread_role.hpp"

namespace convexcut::daemon {

// What the process and its threads ask of the kernel to be on time: SCHED_FIFO, CPUs, memory that
// is locked and never given back. Design note: docs/design/realtime.md.
class Realtime {
 public:
  // Prepares the process; before it has other threads. Throws config::ConfigError when a CPU list
  // names none that is there, and std::runtime_error of one line when realtime.enabled is "on" and
  // not permitted.
  explicit Realtime(config::RealtimeSettings settings);

  // One line each: what was asked for and refused, and what to do about it. The daemon then runs
  // on, and may be late when the host is busy.
  [[nodiscard]] const std::vector<std::string>& problems() const noexcept { return problems_; }
  // Whether threads are scheduled by SCHED_FIFO.
  [[nodiscard]] bool scheduled() const noexcept { return scheduled_; }
  [[nodiscard]] bool memory_locked() const noexcept { return memory_locked_; }

  // When everything is made and no thread has started yet: what was taken from the heap since the
  // construction gets its pages, where they are not there because memory is locked.
  void populate_memory() const noexcept;

  // The calling thread takes up a role: name (up to 15 characters), scheduling, CPUs, and a stack
  // that is there. As its first thing.
  void enter(ThreadRole role, const char* name) const noexcept;

  // Calls make() with the scheduling and the CPUs of `role`, so that threads that are made in it
  // have them too.
  template <class Make>
  [[nodiscard]] decltype(auto) as(ThreadRole role, Make&& make) const {
    const Borrowed borrowed(*this, role);
    return std::forward<Make>(make)();
  }

 private:
  class Borrowed {
   public:
    Borrowed(const Realtime& realtime, ThreadRole role) noexcept;
    ~Borrowed();
    Borrowed(const Borrowed&) = delete;
    Borrowed& operator=(const Borrowed&) = delete;

   private:
    const Realtime& realtime_;
    cpu_set_t cpus_{};
  };

  void check_cpus() const;
  void try_scheduling();
  void lock_memory();
  void refuse(std::string problem);
  [[nodiscard]] int priority(ThreadRole role) const noexcept;
  [[nodiscard]] const std::string& cpus(ThreadRole role) const noexcept;
  void schedule(ThreadRole role) const noexcept;

  config::RealtimeSettings settings_;
  bool scheduled_ = false;
  bool memory_locked_ = false;
  void* heap_begin_ = nullptr;  // at construction
  std::vector<std::string> problems_;
};

}  // namespace convexcut::daemon
