// SPDX-License-Identifier: Apache-2.0
#include "drivers/serial/serial_port.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>

#include <fcntl.h>
#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

namespace convexcut::serial {
namespace {

constexpr std::array<std::uint32_t, 12> kBauds{4800,   9600,   19200,  38400,   57600,   115200,
                                               230400, 460800, 921600, 2000000, 3500000, 4000000};
constexpr std::array<speed_t, kBauds.size()> kSpeeds{B4800,   B9600,    B19200,   B38400,
                                                     B57600,  B115200,  B230400,  B460800,
                                                     B921600, B2000000, B3500000, B4000000};

std::optional<speed_t> speed_of(std::uint32_t baud) noexcept {
  const auto* found = std::ranges::find(kBauds, baud);
  if (found == kBauds.end()) return std::nullopt;
  return kSpeeds[static_cast<std::size_t>(found - kBauds.begin())];
}

// The lock holds against programs that ask for it too, whoever runs them; TIOCEXCL against all
// others, except root's. A pseudo-terminal would keep the latter after a program that died.
int lock(int fd) noexcept {
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0) return errno == EWOULDBLOCK ? EBUSY : errno;
  constexpr unsigned kFirstPseudoTerminal = 136;  // major numbers, admin-guide/devices.txt
  constexpr unsigned kLastPseudoTerminal = 143;
  struct stat file {};
  if (::fstat(fd, &file) != 0) return errno;
  const unsigned type = major(file.st_rdev);
  if (type < kFirstPseudoTerminal || type > kLastPseudoTerminal) ::ioctl(fd, TIOCEXCL);
  return 0;
}

}  // namespace

std::span<const std::uint32_t> supported_bauds() noexcept { return kBauds; }
bool is_supported(std::uint32_t baud) noexcept { return speed_of(baud).has_value(); }

std::uint32_t baud_of(const termios& settings) noexcept {
  const auto* found = std::ranges::find(kSpeeds, ::cfgetospeed(&settings));
  if (found == kSpeeds.end()) return 0;
  return kBauds[static_cast<std::size_t>(found - kSpeeds.begin())];
}

int SerialPort::open(const std::string& device, std::uint32_t baud) noexcept {
  close();
  fd_ = live::FileDescriptor(::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!fd_) return errno;
  const int error = set_up(baud);
  if (error != 0) close();
  return error;
}

void SerialPort::close() noexcept {
  fd_.reset();
  low_latency_ = false;
}

int SerialPort::set_up(std::uint32_t baud) noexcept {
  const int fd = fd_.get();
  termios settings{};
  if (::tcgetattr(fd, &settings) != 0) return errno;
  if (const int error = lock(fd); error != 0) return error;
  ::cfmakeraw(&settings);
  settings.c_cflag |= CS8 | CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(PARENB | CSTOPB | CRTSCTS);
  settings.c_cc[VMIN] = 1;  // with 0 a read of nothing would look like the end of the line
  settings.c_cc[VTIME] = 0;
  if (baud != 0) {
    const std::optional<speed_t> speed = speed_of(baud);
    if (!speed || ::cfsetspeed(&settings, *speed) != 0) return EINVAL;
  }
  if (::tcsetattr(fd, TCSANOW, &settings) != 0) return errno;
  ask_for_low_latency();
  // Older bytes would be stamped as of now.
  return ::tcflush(fd, TCIFLUSH) == 0 ? 0 : errno;
}

void SerialPort::ask_for_low_latency() noexcept {
  serial_struct driver{};
  if (::ioctl(fd_.get(), TIOCGSERIAL, &driver) != 0) return;  // a pty, or CDC-ACM: no such setting
  driver.flags |= static_cast<int>(ASYNC_LOW_LATENCY);
  low_latency_ = ::ioctl(fd_.get(), TIOCSSERIAL, &driver) == 0;
}

int SerialPort::read(wire::WritableBytes buffer, std::size_t& size) noexcept {
  size = 0;
  const ssize_t count = ::read(fd_.get(), buffer.data(), buffer.size());
  if (count < 0) return errno;
  if (count == 0) return EIO;
  size = static_cast<std::size_t>(count);
  return 0;
}

int SerialPort::write(wire::Bytes bytes) noexcept {
  const ssize_t count = ::write(fd_.get(), bytes.data(), bytes.size());
  if (count < 0) return errno;
  return static_cast<std::size_t>(count) == bytes.size() ? 0 : EAGAIN;
}

int SerialPort::set_baud(std::uint32_t baud) noexcept {
  const std::optional<speed_t> speed = speed_of(baud);
  termios settings{};
  if (!speed || ::tcgetattr(fd_.get(), &settings) != 0) return EINVAL;
  if (::cfsetspeed(&settings, *speed) != 0) return EINVAL;
  return ::tcsetattr(fd_.get(), TCSANOW, &settings) == 0 ? 0 : errno;
}

}  // namespace convexcut::serial
