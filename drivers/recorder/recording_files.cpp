// SPDX-License-Identifier: Apache-2.0
#include "drivers/recorder/recording_files.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <system_error>

namespace convexcut::recorder {
namespace {

constexpr std::array<std::string_view, kStreams> kNames{"lidar", "imu", "can"};
constexpr std::string_view kExtension = ".pcap";
constexpr std::size_t kLeastDigits = 3;

capture::LinkKind link_of(Stream stream) noexcept {
  switch (stream) {
    case Stream::lidar:
      return capture::LinkKind::ethernet;
    case Stream::imu:
      return capture::LinkKind::serial;
    case Stream::can:
      break;
  }
  return capture::LinkKind::can;
}

std::string file_name(Stream stream, unsigned segment) {
  const std::string digits = std::to_string(segment);
  return std::string(kNames[static_cast<std::size_t>(stream)]) + "_" +
         std::string(kLeastDigits - std::min(kLeastDigits, digits.size()), '0') + digits +
         std::string(kExtension);
}

// The segment that a file belongs to; nothing when it is none of ours.
std::optional<unsigned> segment_of(std::string_view name) {
  for (const std::string_view stream : kNames) {
    if (!name.starts_with(stream) || !name.ends_with(kExtension)) continue;
    std::string_view digits = name.substr(stream.size());
    digits.remove_suffix(kExtension.size());
    if (digits.size() <= kLeastDigits || digits.front() != '_') continue;
    digits.remove_prefix(1);
    unsigned segment = 0;
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), segment);
    if (error == std::errc{} && end == digits.data() + digits.size()) return segment;
  }
  return std::nullopt;
}

struct Segment {
  std::vector<std::filesystem::path> files;
  std::uint64_t bytes = 0;
};

// By number. What cannot be looked at is left out.
std::map<unsigned, Segment> segments_in(const std::filesystem::path& directory) {
  std::map<unsigned, Segment> segments;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(directory, error), end; !error && entry != end;
       entry.increment(error)) {
    const auto number = segment_of(entry->path().filename().string());
    if (!number) continue;
    Segment& segment = segments[*number];
    segment.files.push_back(entry->path());
    std::error_code unknown;
    const std::uintmax_t size = entry->file_size(unknown);
    if (!unknown) segment.bytes += size;
  }
  return segments;
}

}  // namespace

RecordingFiles::RecordingFiles(RecordingOptions options) : options_(std::move(options)) {
  if (options_.keep_bytes > 0) {
    const std::uint64_t largest = std::max<std::uint64_t>(options_.keep_bytes / 4, 1);
    options_.max_file_bytes =
        options_.max_file_bytes == 0 ? largest : std::min(options_.max_file_bytes, largest);
  }
  std::error_code error;
  std::filesystem::create_directories(options_.directory, error);
  if (error) {
    throw capture::CaptureError(
        options_.directory.string() +
        ": cannot make this directory for the recording: " + error.message());
  }
  if (::access(options_.directory.c_str(), W_OK | X_OK) != 0) {
    throw capture::CaptureError(options_.directory.string() +
                                ": cannot be recorded to: " + std::strerror(errno));
  }
  const auto there = segments_in(options_.directory);
  if (!there.empty()) segment_ = there.rbegin()->first + 1;
}

void RecordingFiles::write(Stream stream, const capture::Record& record, SteadyTime now) {
  auto& writer = writers_[static_cast<std::size_t>(stream)];
  if (writer == nullptr) {
    writer =
        std::make_unique<capture::CaptureWriter>(options_.directory / file_name(stream, segment_),
                                                 link_of(stream), capture::Appears::at_once);
    if (!segment_start_) segment_start_ = now;
  }
  writer->write(record);
}

void RecordingFiles::maintain(SteadyTime now) {
  for (const auto& writer : writers_) {
    if (writer != nullptr) writer->flush();
  }
  prune();
  if (free_bytes() < options_.least_free_bytes) {
    throw capture::CaptureError(options_.directory.string() + ": the disk is full but for " +
                                std::to_string(options_.least_free_bytes >> 20U) + " MB");
  }
  if (is_due(now)) close();
}

bool RecordingFiles::is_due(SteadyTime now) const noexcept {
  if (!segment_start_) return false;
  if (options_.max_file_time > Duration{0} && now - *segment_start_ >= options_.max_file_time) {
    return true;
  }
  return options_.max_file_bytes > 0 && std::ranges::any_of(writers_, [this](const auto& writer) {
           return writer != nullptr && writer->bytes() >= options_.max_file_bytes;
         });
}

void RecordingFiles::close() {
  for (const auto& writer : writers_) {
    if (writer != nullptr) writer->flush();
  }
  abandon();
}

void RecordingFiles::abandon() noexcept {
  closed_bytes_ = bytes();
  for (auto& writer : writers_) writer.reset();
  if (segment_start_) ++segment_;
  segment_start_.reset();
}

void RecordingFiles::prune() {
  if (options_.keep_bytes == 0) return;
  const auto segments = segments_in(options_.directory);
  std::uint64_t total = 0;
  for (const auto& [number, segment] : segments) total += segment.bytes;
  for (const auto& [number, segment] : segments) {
    if (total <= options_.keep_bytes || number >= segment_) return;
    std::error_code ignored;  // it is tried again in a second
    for (const auto& file : segment.files) std::filesystem::remove(file, ignored);
    total -= segment.bytes;
    ++deleted_segments_;
  }
}

std::uint64_t RecordingFiles::free_bytes() const {
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(options_.directory, error);
  if (error) {
    throw capture::CaptureError(options_.directory.string() +
                                ": cannot be recorded to: " + error.message());
  }
  return space.available;
}

std::uint64_t RecordingFiles::bytes() const noexcept {
  std::uint64_t total = closed_bytes_;
  for (const auto& writer : writers_) total += writer != nullptr ? writer->bytes() : 0;
  return total;
}

}  // namespace convexcut::recorder
