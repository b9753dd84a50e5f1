// SPDX-License-Identifier: Apache-2.0
#include "daemon/realtime/realtime.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <malloc.h>

#include "config/loader.hpp"
#include "config/text_rules.hpp"

namespace convexcut::daemon {
namespace {

// Locked memory includes the whole stack of every thread: the default of 8 MiB each would be more
// than all the rest. The deepest frames, those of DDS, need a tenth of this.
[[maybe_unused]] constexpr std::size_t kStackBytes = std::size_t{512} * 1024;
// Of the stack, touched at the start where memory cannot be locked. No frame of ours is deeper.
constexpr std::size_t kPrefaultBytes = std::size_t{128} * 1024;

constexpr std::size_t kPageBytes = 4096;

constexpr const char* kFullStop =
    "; the daemon runs on and may be late when the host is busy (realtime.enabled = \"off\" for no "
    "warning)";

[[nodiscard]] cpu_set_t cpu_set(const std::string& list) noexcept {
  const config::CpuSet wanted = config::parse_cpus(list).value_or(config::CpuSet{}.set());
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  for (std::size_t cpu = 0; cpu < wanted.size() && cpu < CPU_SETSIZE; ++cpu) {
    if (wanted.test(cpu)) CPU_SET(cpu, &cpus);
  }
  return cpus;
}

[[gnu::noinline]] void touch_stack() noexcept {
  std::array<std::byte, kPrefaultBytes> stack;
  std::byte* const volatile all = stack.data();  // volatile: the writing counts, not the bytes
  std::memset(all, 0, stack.size());
}

// More than the daemon ever has.
constexpr std::size_t kLockedBytes = std::size_t{512} * 1024 * 1024;

// Asks without touching a page: with too low a limit, mlockall() could succeed and every later
// allocation fail.
[[nodiscard]] bool may_lock(std::size_t bytes) noexcept {
  void* const room = ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (room == MAP_FAILED) return false;
  const bool locked = ::mlock2(room, bytes, MLOCK_ONFAULT) == 0;
  const int error = errno;
  ::munmap(room, bytes);
  errno = error;
  return locked;
}

// What is freed stays with the process, and large blocks come from the heap like small ones: no
// page is given back, to be mapped and cleared anew with the next scan.
void keep_memory() noexcept {
  ::mallopt(M_TRIM_THRESHOLD, -1);
  ::mallopt(M_MMAP_MAX, 0);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // these need far more
  pthread_attr_t attributes;
  if (::pthread_attr_init(&attributes) != 0) return;
  ::pthread_attr_setstacksize(&attributes, kStackBytes);
  ::pthread_setattr_default_np(&attributes);
  ::pthread_attr_destroy(&attributes);
#endif
}

}  // namespace

Realtime::Realtime(config::RealtimeSettings settings) : settings_(std::move(settings)) {
  check_cpus();
  if (settings_.enabled == config::Realtime::off) return;
  keep_memory();
  heap_begin_ = ::sbrk(0);
  try_scheduling();
  if (settings_.lock_memory) lock_memory();
}

void Realtime::check_cpus() const {
  cpu_set_t before;
  if (::sched_getaffinity(0, sizeof before, &before) != 0) return;
  for (const auto& [key, list] : {std::pair{"realtime.receive_cpus", &settings_.receive_cpus},
                                  std::pair{"realtime.worker_cpus", &settings_.worker_cpus},
                                  std::pair{"realtime.publish_cpus", &settings_.publish_cpus}}) {
    const cpu_set_t wanted = cpu_set(*list);
    if (::sched_setaffinity(0, sizeof wanted, &wanted) != 0) {
      throw config::ConfigError(std::string(key) + ": expected CPUs of this host, found \"" +
                                *list + "\" (see lscpu)");
    }
    ::sched_setaffinity(0, sizeof before, &before);
  }
}

void Realtime::try_scheduling() {
  const sched_param highest{priority(ThreadRole::receive)};
  if (const int error = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &highest)) {
    refuse("realtime scheduling (SCHED_FIFO) is refused: " + std::string(std::strerror(error)) +
           ": allow it with LimitRTPRIO=" + std::to_string(highest.sched_priority) +
           " in the unit, `ulimit -r`, or `setcap cap_sys_nice,cap_ipc_lock+ep` on convexcutd");
    return;
  }
  const sched_param normal{0};
  ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &normal);
  scheduled_ = true;
}

void Realtime::lock_memory() {
  if (may_lock(kLockedBytes) && ::mlockall(MCL_CURRENT | MCL_FUTURE) == 0) {
    memory_locked_ = true;
    return;
  }
  refuse("locking memory (mlockall) is refused: " + std::string(std::strerror(errno)) +
         ": allow it with LimitMEMLOCK=infinity in the unit, `ulimit -l unlimited`, or `setcap "
         "cap_sys_nice,cap_ipc_lock+ep` on convexcutd");
}

// All of it is one range: nothing is mapped apart (see keep_memory), and nothing is given back.
void Realtime::populate_memory() const noexcept {
  if (memory_locked_ || heap_begin_ == nullptr) return;
  const std::size_t into_page = reinterpret_cast<std::uintptr_t>(heap_begin_) % kPageBytes;
  std::byte* const begin =
      static_cast<std::byte*>(heap_begin_) + (kPageBytes - into_page) % kPageBytes;
  const std::ptrdiff_t bytes = static_cast<std::byte*>(::sbrk(0)) - begin;
  if (bytes <= 0) return;
  // Kernels before 5.14 refuse: then the pages come with their first use.
  ::madvise(begin, static_cast<std::size_t>(bytes), MADV_POPULATE_WRITE);
}

void Realtime::refuse(std::string problem) {
  if (settings_.enabled == config::Realtime::on) {
    throw std::runtime_error("realtime.enabled is \"on\", but " + problem);
  }
  problems_.push_back(std::move(problem) + kFullStop);
}

void Realtime::enter(ThreadRole role, const char* name) const noexcept {
  ::pthread_setname_np(::pthread_self(), name);
  // SCHED_OTHER sleeps may be stretched by the timer slack, 50 µs unless set.
  ::prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  if (is_realtime(role)) touch_stack();
  schedule(role);
}

void Realtime::schedule(ThreadRole role) const noexcept {
  if (!cpus(role).empty()) {
    const cpu_set_t wanted = cpu_set(cpus(role));
    ::sched_setaffinity(0, sizeof wanted, &wanted);
  }
  if (!scheduled_ || role == ThreadRole::other) return;
  const sched_param fifo{priority(role)};
  ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &fifo);
}

int Realtime::priority(ThreadRole role) const noexcept {
  switch (role) {
    case ThreadRole::receive:
      return static_cast<int>(settings_.receive_priority);
    case ThreadRole::worker:
      return static_cast<int>(settings_.worker_priority);
    case ThreadRole::publish:
      return static_cast<int>(settings_.publish_priority);
    case ThreadRole::transport:
      return static_cast<int>(std::max(settings_.publish_priority - 1, 1U));
    case ThreadRole::other:
      return 0;
  }
  return 0;
}

const std::string& Realtime::cpus(ThreadRole role) const noexcept {
  static const std::string all;
  switch (role) {
    case ThreadRole::receive:
      return settings_.receive_cpus;
    case ThreadRole::worker:
      return settings_.worker_cpus;
    case ThreadRole::publish:
      return settings_.publish_cpus;
    case ThreadRole::transport:
    case ThreadRole::other:
      return all;
  }
  return all;
}

Realtime::Borrowed::Borrowed(const Realtime& realtime, ThreadRole role) noexcept
    : realtime_(realtime) {
  ::sched_getaffinity(0, sizeof cpus_, &cpus_);
  realtime_.schedule(role);
}

Realtime::Borrowed::~Borrowed() {
  if (realtime_.scheduled_) {
    const sched_param normal{0};
    ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &normal);
  }
  ::sched_setaffinity(0, sizeof cpus_, &cpus_);
}

}  // namespace convexcut::daemon
