// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "core/counter.hpp"
#include "core/time.hpp"
#include "daemon/realtime/thread_role.hpp"

namespace convexcut::daemon {

// What a thread did to the promise of its role since mark_steady(), and the time it took since it
// began.
struct ThreadFigures {
  std::string_view name;
  ThreadRole role = ThreadRole::other;
  std::uint64_t allocations = 0;   // calls of the allocator, releases included
  std::uint64_t minor_faults = 0;  // pages mapped on first use
  std::uint64_t major_faults = 0;  // pages fetched from disk
  Duration cpu_time{0};
};

// The kernel's own account of one of this process's threads (proc(5), /proc/pid/task/tid/stat).
struct ThreadUsage {
  std::uint64_t minor_faults = 0;
  std::uint64_t major_faults = 0;
  Duration cpu_time{0};
};
// Nothing when there is no such thread (any longer). Allocates.
[[nodiscard]] std::optional<ThreadUsage> thread_usage(pid_t tid);
// From the text of that file; nothing when it is none. `ticks_per_second`: sysconf(_SC_CLK_TCK).
[[nodiscard]] std::optional<ThreadUsage> parse_thread_usage(std::string_view stat,
                                                            long ticks_per_second) noexcept;

// The threads that are watched. Threads enter themselves; one other thread reads.
class ThreadRegister {
 public:
  static constexpr std::size_t kMaxThreads = 16;

  // The calling thread, which is one of kMaxThreads at most (further ones are not watched). `name`
  // outlives the register. Its allocator calls are counted from now on.
  void enter(const char* name, ThreadRole role) noexcept;
  // The calling thread is about to end: what its runtime releases then is not counted.
  static void leave() noexcept;

  // What came before is start-up and is not counted.
  void mark_steady();
  // Of the realtime threads, or of all. Threads that have ended keep what was last read.
  [[nodiscard]] std::vector<ThreadFigures> figures();

 private:
  struct Entry {
    const char* name = nullptr;
    ThreadRole role = ThreadRole::other;
    pid_t tid = 0;
    Counter allocations;
    // The reader's: as of mark_steady(), and as last read.
    std::uint64_t allocations_before = 0;
    ThreadUsage before;
    ThreadUsage newest;
  };
  static void read(Entry& entry);

  std::array<Entry, kMaxThreads> entries_;
  // Entries are claimed by count_, filled, and then published by ready_ of the same index.
  std::atomic<std::size_t> count_{0};
  std::array<std::atomic<bool>, kMaxThreads> ready_{};
};

}  // namespace convexcut::daemon
