// SPDX-License-Identifier: Apache-2.0
#include "drivers/capture/serial_log.hpp"

#include <cerrno>
#include <cstring>

#include "drivers/capture/open_input.hpp"

namespace convexcut::capture {

void SerialLog::Close::operator()(std::FILE* stream) const noexcept {
  static_cast<void>(std::fclose(stream));
}

SerialLog::SerialLog(const std::filesystem::path& file)
    : name_(file.string()),
      stream_(open_input(file, "a recording of a serial line")),
      file_size_(size_of(stream_.get())) {
  const int first = std::fgetc(stream_.get());
  if (first == EOF) {
    if (std::ferror(stream_.get()) != 0) {
      throw CaptureError(name_ + ": cannot read: " + std::strerror(errno));
    }
    throw CaptureError(name_ + ": is empty, expected a recording of a serial line");
  }
  static_cast<void>(std::ungetc(first, stream_.get()));  // one byte always fits
}

ReadStatus SerialLog::next(std::span<const std::byte>& chunk) noexcept {
  chunk = {};
  if (status_ != ReadStatus::record) return status_;
  const std::size_t count = std::fread(buffer_.data(), 1, buffer_.size(), stream_.get());
  if (count == 0) {
    error_number_ = errno;
    status_ = std::ferror(stream_.get()) != 0 ? ReadStatus::failed : ReadStatus::end;
    return status_;
  }
  bytes_read_ += count;
  chunk = std::span(buffer_).first(count);
  return ReadStatus::record;
}

std::string SerialLog::problem() const {
  if (status_ != ReadStatus::failed) return {};
  return name_ + ": cannot read on at byte " + std::to_string(bytes_read_) + ": " +
         std::strerror(error_number_);
}

}  // namespace convexcut::capture
