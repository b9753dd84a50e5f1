// SPDX-License-Identifier: Apache-2.0
#include "tests/support/run_program.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/recordings.hpp"

namespace convexcut::test {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// In the child, between fork and exec.
void redirect(const std::filesystem::path& file, int to) {
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (fd < 0 || ::dup2(fd, to) < 0) ::_exit(126);
}

void apply(const ProgramLimits& limits) {
  if (limits.file_size_bytes < 0) return;
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = static_cast<rlim_t>(limits.file_size_bytes);  // a test may lift it again
  ::signal(SIGXFSZ, SIG_IGN);
  if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) ::_exit(126);
}

// Waits for the child; sends it SIGTERM once when it has written the awaited text.
int wait_for(pid_t child, const std::filesystem::path& out, const std::filesystem::path& err,
             const std::string& terminate_at) {
  int status = 0;
  bool terminated = terminate_at.empty();
  while (!terminated) {
    if (::waitpid(child, &status, WNOHANG) == child) return status;
    if ((text_of(out) + text_of(err)).find(terminate_at) != std::string::npos) {
      ::kill(child, SIGTERM);
      terminated = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  if (::waitpid(child, &status, 0) != child) throw std::runtime_error("cannot wait for a program");
  return status;
}

}  // namespace

std::size_t ProgramResult::error_lines() const {
  return static_cast<std::size_t>(std::count(err.begin(), err.end(), '\n'));
}

pid_t start_program(const std::string& name, const std::vector<std::string>& arguments,
                    const ProgramLimits& limits, const std::filesystem::path& directory) {
  std::string program = std::string(CONVEXCUT_PROGRAMS) + "/" + name;
  std::vector<std::string> words = arguments;
  std::vector<char*> argv{program.data()};
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) {
    ::close(STDIN_FILENO);
    redirect(directory / "out", STDOUT_FILENO);
    redirect(directory / "err", STDERR_FILENO);
    apply(limits);
    ::execv(program.c_str(), argv.data());
    ::_exit(127);
  }
  return child;
}

ProgramResult program_result(int status, const std::filesystem::path& directory) {
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
          text_of(directory / "out"), text_of(directory / "err")};
}

ProgramResult run_program(const std::string& name, const std::vector<std::string>& arguments,
                          const ProgramLimits& limits) {
  const TemporaryDirectory directory;
  const pid_t child = start_program(name, arguments, limits, directory.path());
  const int status =
      wait_for(child, directory.path() / "out", directory.path() / "err", limits.terminate_at);
  return program_result(status, directory.path());
}

}  // namespace convexcut::test
