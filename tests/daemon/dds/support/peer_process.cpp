// SPDX-License-Identifier: Apache-2.0
#include "support/peer_process.hpp"

#include <array>
#include <csignal>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <spawn.h>

namespace convexcut::daemon::testing {
namespace {

constexpr int kPatienceMs = 20'000;  // for a loaded machine; a working peer needs milliseconds

std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe2 failed");
  return ends;
}

}  // namespace

PeerProcess::PeerProcess(const config::Dds& settings, const std::string& dds_topic) {
  const std::array<int, 2> input = make_pipe();
  const std::array<int, 2> output = make_pipe();
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, input[0], STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, output[1], STDOUT_FILENO);
  std::array<std::string, 4> arguments{CONVEXCUT_DDS_PEER, std::to_string(settings.domain),
                                       settings.profile, dds_topic};
  std::array<char*, 5> argv{arguments[0].data(), arguments[1].data(), arguments[2].data(),
                            arguments[3].data(), nullptr};
  const int result =
      ::posix_spawn(&pid_, CONVEXCUT_DDS_PEER, &actions, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(input[0]);
  ::close(output[1]);
  stdin_ = input[1];
  stdout_ = output[0];
  if (result != 0) throw std::runtime_error("cannot start " CONVEXCUT_DDS_PEER);
}

PeerProcess::~PeerProcess() {
  ::close(stdin_);
  ::close(stdout_);
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
}

std::string PeerProcess::read_line() {
  while (true) {
    const std::size_t end = pending_.find('\n');
    if (end != std::string::npos) {
      std::string line = pending_.substr(0, end);
      pending_.erase(0, end + 1);
      return line;
    }
    pollfd ready{stdout_, POLLIN, 0};
    if (::poll(&ready, 1, kPatienceMs) <= 0) return "";
    std::array<char, 256> buffer;
    const ssize_t got = ::read(stdout_, buffer.data(), buffer.size());
    if (got <= 0) return "";
    pending_.append(buffer.data(), static_cast<std::size_t>(got));
  }
}

void PeerProcess::stop() const {
  ::kill(pid_, SIGSTOP);
  ::waitpid(pid_, nullptr, WUNTRACED);
}

void PeerProcess::carry_on() const { ::kill(pid_, SIGCONT); }

}  // namespace convexcut::daemon::testing
