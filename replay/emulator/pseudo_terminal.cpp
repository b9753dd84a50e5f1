// SPDX-License-Identifier: Apache-2.0
#include "replay/emulator/pseudo_terminal.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include "drivers/serial/serial_port.hpp"

namespace convexcut::replay {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error("cannot make a pseudo-terminal for the IMU: " + what + ": " +
                           std::strerror(errno));
}

}  // namespace

PseudoTerminal::PseudoTerminal(std::filesystem::path link)
    : link_(std::move(link)), fd_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
  std::array<char, 64> name{};
  if (!fd_) fail("posix_openpt");
  if (::grantpt(fd_.get()) != 0 || ::unlockpt(fd_.get()) != 0 ||
      ::ptsname_r(fd_.get(), name.data(), name.size()) != 0) {
    fail("no name");
  }
  path_ = name.data();
  // Opened once: only a terminal that was open can be seen to be closed. No echo from the start.
  serial::SerialPort terminal;
  if (const int error = terminal.open(path_, 115200); error != 0) {
    errno = error;
    fail(path_);
  }
  if (link_.empty()) return;
  std::error_code error;
  if (std::filesystem::is_symlink(link_)) std::filesystem::remove(link_, error);
  std::filesystem::create_symlink(path_, link_, error);
  if (error) {
    throw std::runtime_error("--imu-link " + link_.string() + ": " + error.message() +
                             ": expected a path that does not exist, or a symbolic link");
  }
}

PseudoTerminal::~PseudoTerminal() {
  std::error_code ignored;
  if (!link_.empty() && std::filesystem::read_symlink(link_, ignored) == path_) {
    std::filesystem::remove(link_, ignored);
  }
}

bool PseudoTerminal::heard() const {
  pollfd poll{fd_.get(), 0, 0};
  return ::poll(&poll, 1, 0) == 0 || (poll.revents & POLLHUP) == 0;
}

std::uint32_t PseudoTerminal::baud() const {
  termios settings{};
  if (::tcgetattr(fd_.get(), &settings) != 0) return 0;
  return serial::baud_of(settings);
}

std::size_t PseudoTerminal::send(wire::Bytes bytes) {
  if (!heard()) return 0;
  const ssize_t count = ::write(fd_.get(), bytes.data(), bytes.size());
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

std::vector<std::byte> PseudoTerminal::receive() {
  std::vector<std::byte> all;
  std::array<std::byte, 4096> buffer;
  while (true) {
    const ssize_t count = ::read(fd_.get(), buffer.data(), buffer.size());
    if (count <= 0) return all;
    all.insert(all.end(), buffer.begin(), buffer.begin() + count);
  }
}

}  // namespace convexcut::replay
