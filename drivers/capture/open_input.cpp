// SPDX-License-Identifier: Apache-2.0
#include "drivers/capture/open_input.hpp"

#include <cerrno>
#include <cstring>
#include <string>

#include <sys/types.h>
#include <system_error>

#include "drivers/capture/capture_error.hpp"

namespace convexcut::capture {

std::FILE* open_input(const std::filesystem::path& file, const char* expected) {
  // fopen() succeeds on a directory; only reading would fail.
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw CaptureError(file.string() + ": is a directory, expected " + expected);
  }
  std::FILE* stream = std::fopen(file.c_str(), "rbe");
  if (stream == nullptr) {
    throw CaptureError(file.string() + ": cannot open: " + std::strerror(errno));
  }
  return stream;
}

std::uint64_t size_of(std::FILE* stream) noexcept {
  if (::fseeko(stream, 0, SEEK_END) != 0) return 0;
  const ::off_t size = ::ftello(stream);
  if (::fseeko(stream, 0, SEEK_SET) != 0 || size < 0) return 0;
  return static_cast<std::uint64_t>(size);
}

}  // namespace convexcut::capture
