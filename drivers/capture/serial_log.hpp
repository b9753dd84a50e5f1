// SPDX-License-Identifier: Apache-2.0
//
// A raw recording of a serial line (.bin): its bytes and nothing else, so no stamps either.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "drivers/capture/capture_error.hpp"

namespace convexcut::capture {

class SerialLog {
 public:
  static constexpr std::size_t kChunkSize = 4096;

  // Throws CaptureError when the file is missing, empty or a directory.
  explicit SerialLog(const std::filesystem::path& file);

  // The next 1 … kChunkSize bytes, valid until the next call. ReadStatus::record, ::end or
  // ::failed; once it is not ::record, the answer stays and `chunk` is empty.
  [[nodiscard]] ReadStatus next(std::span<const std::byte>& chunk) noexcept;

  // One line that says what is wrong after ReadStatus::failed, otherwise empty.
  [[nodiscard]] std::string problem() const;

  [[nodiscard]] std::uint64_t bytes_read() const noexcept { return bytes_read_; }
  // 0 when the input is not a regular file.
  [[nodiscard]] std::uint64_t file_size() const noexcept { return file_size_; }

 private:
  struct Close {
    void operator()(std::FILE* stream) const noexcept;
  };

  std::string name_;
  std::unique_ptr<std::FILE, Close> stream_;
  std::uint64_t file_size_ = 0;
  std::uint64_t bytes_read_ = 0;
  int error_number_ = 0;
  ReadStatus status_ = ReadStatus::record;
  std::array<std::byte, kChunkSize> buffer_{};
};

}  // namespace convexcut::capture
