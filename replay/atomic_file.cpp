// SPDX-License-Identifier: Apache-2.0
#include "replay/atomic_file.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace convexcut::replay {

AtomicFile::AtomicFile(std::filesystem::path name)
    : name_(std::move(name)),
      part_(std::filesystem::path(name_).concat(".part")),
      fd_(::open(part_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (fd_ < 0) fail("create", errno);
}

AtomicFile::~AtomicFile() {
  if (fd_ < 0) return;
  ::close(fd_);
  ::unlink(part_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("write", errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AtomicFile::commit() {
  // close() is where some file systems (NFS, quotas) first say that the disk is full.
  const int closed = ::close(std::exchange(fd_, -1));
  const int close_error = errno;
  if (closed != 0 || ::rename(part_.c_str(), name_.c_str()) != 0) {
    const int error_number = closed != 0 ? close_error : errno;
    ::unlink(part_.c_str());
    fail("finish", error_number);
  }
}

void AtomicFile::fail(const char* doing, int error_number) const {
  throw std::runtime_error("cannot " + std::string(doing) + " " + name_.string() + ": " +
                           std::strerror(error_number));
}

}  // namespace convexcut::replay
