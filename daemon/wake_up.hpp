// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cerrno>
#include <cstdint>
#include <ctime>

#include <poll.h>
#include <sys/eventfd.h>
#include <system_error>
#include <unistd.h>

#include "core/time.hpp"

namespace convexcut::daemon {

// Lets the consumer of a ring sleep until its producer has put something into it. A wake-up that
// comes between looking into the ring and sleeping is kept: none is missed.
class WakeUp {
 public:
  // Throws std::system_error.
  WakeUp() : fd_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    if (fd_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
  }
  ~WakeUp() { ::close(fd_); }
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  // Producer thread. RT: one system call, which never waits.
  void notify() noexcept {
    constexpr std::uint64_t kOne = 1;
    // Fails only when it has been notified 2^64 times without anybody looking: then it is set.
    [[maybe_unused]] const ssize_t written = ::write(fd_, &kOne, sizeof kOne);
  }

  // Consumer thread. Returns when it was notified since the last return, at the latest after
  // `longest` (below 1 s).
  void wait(Duration longest) noexcept {
    pollfd poll{fd_, POLLIN, 0};
    const std::timespec timeout{0, static_cast<long>(longest.count())};
    if (::ppoll(&poll, 1, &timeout, nullptr) <= 0) return;
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t read = ::read(fd_, &count, sizeof count);
  }

 private:
  int fd_;
};

}  // namespace convexcut::daemon
