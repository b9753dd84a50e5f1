// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cerrno>
#include <csignal>

#include <sys/signalfd.h>
#include <system_error>
#include <unistd.h>

#include "drivers/live/file_descriptor.hpp"

namespace convexcut::replay {

// What a system call gave, if it did.
[[nodiscard]] inline live::FileDescriptor require_descriptor(int fd, const char* what) {
  if (fd < 0) throw std::system_error(errno, std::generic_category(), what);
  return live::FileDescriptor(fd);
}

// SIGINT and SIGTERM as something to poll. To be made before other threads are started: they
// inherit the mask, so that none of them takes the signal.
class StopSignal {
 public:
  // Throws std::system_error.
  StopSignal()
      : fd_(require_descriptor(::signalfd(-1, &block(), SFD_CLOEXEC | SFD_NONBLOCK), "signalfd")) {}
  ~StopSignal() {
    static_cast<void>(came());  // else it would come once more when it is let through
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  [[nodiscard]] int fd() const noexcept { return fd_.get(); }
  // Whether one has come since the last call.
  [[nodiscard]] bool came() const noexcept {
    signalfd_siginfo taken{};
    bool any = false;
    while (::read(fd_.get(), &taken, sizeof taken) > 0) any = true;
    return any;
  }

 private:
  const sigset_t& block() {
    ::sigemptyset(&signals_);
    ::sigaddset(&signals_, SIGINT);
    ::sigaddset(&signals_, SIGTERM);
    ::pthread_sigmask(SIG_BLOCK, &signals_, &before_);
    return signals_;
  }
  sigset_t signals_{};
  sigset_t before_{};
  live::FileDescriptor fd_;
};

}  // namespace convexcut::replay
