// SPDX-License-Identifier: Apache-2.0
#include "tests/support/background_program.hpp"

#include <chrono>
#include <csignal>
#include <thread>

#include <sys/wait.h>

namespace convexcut::test {

BackgroundProgram::BackgroundProgram(const std::string& name,
                                     const std::vector<std::string>& arguments,
                                     const ProgramLimits& limits)
    : pid_(start_program(name, arguments, limits, directory_.path())) {}

BackgroundProgram::~BackgroundProgram() {
  if (ended()) return;
  send(SIGKILL);
  ::waitpid(pid_, &status_, 0);
}

std::string BackgroundProgram::err() const { return program_result(0, directory_.path()).err; }

bool BackgroundProgram::wait_for(const std::string& text) {
  while (err().find(text) == std::string::npos) {
    if (ended()) return err().find(text) != std::string::npos;
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  return true;
}

void BackgroundProgram::send(int signal) const { ::kill(pid_, signal); }

ProgramResult BackgroundProgram::stop() {
  if (!ended()) {
    send(SIGTERM);
    ::waitpid(pid_, &status_, 0);
    ended_ = true;
  }
  return program_result(status_, directory_.path());
}

bool BackgroundProgram::ended() {
  if (!ended_) ended_ = ::waitpid(pid_, &status_, WNOHANG) == pid_;
  return ended_;
}

}  // namespace convexcut::test
