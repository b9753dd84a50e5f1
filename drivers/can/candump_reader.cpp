// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/candump_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace convexcut::can {

CandumpReader::CandumpReader(const std::filesystem::path& file, std::string interface)
    : name_(file.string()),
      interface_(std::move(interface)),
      stream_(std::fopen(name_.c_str(), "rb")) {
  if (stream_ == nullptr) {
    throw std::runtime_error(name_ + ": cannot open the candump log: " + std::strerror(errno));
  }
  // A directory opens well and fails at the first read.
  if (!refill() && error_number_ != 0) throw std::runtime_error(problem());
}

bool CandumpReader::refill() noexcept {
  errno = 0;
  begin_ = 0;
  end_ = std::fread(block_.data(), 1, block_.size(), stream_.get());
  if (end_ == 0 && std::ferror(stream_.get()) != 0) error_number_ = errno != 0 ? errno : EIO;
  return end_ > 0;
}

std::optional<CandumpReader::Line> CandumpReader::next_line() noexcept {
  std::size_t length = 0;
  bool started = false;
  bool too_long = false;
  while (begin_ < end_ || (error_number_ == 0 && refill())) {
    started = true;
    const char* const first = block_.data() + begin_;
    const void* const found = std::memchr(first, '\n', end_ - begin_);
    const std::size_t piece =
        found != nullptr ? static_cast<std::size_t>(static_cast<const char*>(found) - first)
                         : end_ - begin_;
    const std::size_t kept = std::min(piece, line_.size() - length);
    std::memcpy(line_.data() + length, first, kept);
    length += kept;
    too_long = too_long || kept < piece;
    begin_ += piece + (found != nullptr ? 1 : 0);
    if (found != nullptr) break;
  }
  if (!started) return std::nullopt;
  return Line{{line_.data(), length}, too_long};
}

CandumpReader::Status CandumpReader::next(CanFrame& frame) noexcept {
  while (const std::optional<Line> line = next_line()) {
    counters_.lines.add();
    CandumpLine parsed;
    const CandumpStatus status = parse_candump_line(line->text, parsed);
    // CAN XL lines may be long, and their beginning tells what they are.
    if (line->too_long && status != CandumpStatus::can_xl) {
      counters_.too_long_lines.add();
    } else if (status != CandumpStatus::frame) {
      count(status);
    } else if (!interface_.empty() && parsed.interface != interface_) {
      counters_.other_interfaces.add();
    } else {
      counters_.frames.add();
      frame = parsed.frame;
      return Status::frame;
    }
  }
  return error_number_ == 0 ? Status::end : Status::failed;
}

void CandumpReader::count(CandumpStatus status) noexcept {
  switch (status) {
    case CandumpStatus::frame:
    case CandumpStatus::blank:
      return;
    case CandumpStatus::drop_note:
      return counters_.drop_notes.add();
    case CandumpStatus::can_xl:
      return counters_.can_xl.add();
    case CandumpStatus::bad_time:
    case CandumpStatus::bad_name:
    case CandumpStatus::bad_id:
    case CandumpStatus::bad_data:
    case CandumpStatus::bad_ending:
      return counters_.malformed_lines.add();
  }
}

std::string CandumpReader::problem() const {
  if (error_number_ == 0) return {};
  return name_ + ": cannot read the candump log: " + std::strerror(error_number_);
}

}  // namespace convexcut::can
