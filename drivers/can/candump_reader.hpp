// SPDX-License-Identifier: Apache-2.0
//
// Streams a candump log file frame by frame, in constant memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/counter.hpp"
#include "drivers/can/can_frame.hpp"
#include "drivers/can/candump.hpp"

namespace convexcut::can {

struct CandumpCounters {
  Counter lines;
  Counter frames;
  Counter other_interfaces;  // frames of interfaces that were not asked for
  Counter drop_notes;        // the recording itself lost frames here
  Counter can_xl;
  Counter too_long_lines;
  Counter malformed_lines;  // any other line that is not blank
};

class CandumpReader {
 public:
  static constexpr std::size_t kMaxLine = 512;  // the longest CAN FD line has about 250 characters

  enum class Status : std::uint8_t {
    frame,   // there is one more
    end,     // the file was read to its end
    failed,  // the rest cannot be read: problem() says why
  };

  // Frames of `interface` only, or of all when it is empty. Throws std::runtime_error, one line
  // with the path and the reason, when the file cannot be opened or read.
  explicit CandumpReader(const std::filesystem::path& file, std::string interface = {});

  // The next frame; lines that are none are counted. Once the answer is not ::frame it stays.
  [[nodiscard]] Status next(CanFrame& frame) noexcept;

  // One line that says what is wrong after Status::failed, otherwise empty.
  [[nodiscard]] std::string problem() const;
  // The number of the line that next() last read, from 1.
  [[nodiscard]] std::uint64_t line_number() const noexcept { return counters_.lines.value(); }
  [[nodiscard]] const CandumpCounters& counters() const noexcept { return counters_; }

 private:
  struct Close {
    void operator()(std::FILE* stream) const noexcept {
      static_cast<void>(std::fclose(stream));  // only read from: nothing can be lost
    }
  };
  struct Line {
    std::string_view text;  // its first kMaxLine characters, until the next call
    bool too_long = false;
  };

  // The next line without its end; empty at the end of the file.
  std::optional<Line> next_line() noexcept;
  bool refill() noexcept;
  void count(CandumpStatus status) noexcept;

  std::string name_;
  std::string interface_;
  std::unique_ptr<std::FILE, Close> stream_;
  std::array<char, 65536> block_{};
  std::size_t begin_ = 0;  // block_[begin_, end_) is not read yet
  std::size_t end_ = 0;
  std::array<char, kMaxLine> line_{};
  int error_number_ = 0;
  CandumpCounters counters_;
};

}  // namespace convexcut::can
