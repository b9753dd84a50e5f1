// SPDX-License-Identifier: Apache-2.0
//
// The files of a recording: a directory of numbered segments, each of up to three captures that
// begin and end together.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "core/time.hpp"
#include "drivers/capture/capture_writer.hpp"

namespace convexcut::recorder {

enum class Stream : std::uint8_t { lidar, imu, can };
inline constexpr std::size_t kStreams = 3;

struct RecordingOptions {
  std::filesystem::path directory;
  std::uint64_t max_file_bytes = 0;  // 0: no limit
  Duration max_file_time{0};         // 0: no limit
  // Of all segments in the directory together: the oldest are deleted, but not the one that is
  // being written, of which no file gets larger than a quarter of this. 0: none is.
  std::uint64_t keep_bytes = 0;
  // With less room than this left on the disk, recording stops: the machine needs some.
  std::uint64_t least_free_bytes = 64U << 20U;
};

// DIRECTORY/lidar_000.pcap, imu_000.pcap, can_000.pcap, then …_001.pcap: a file appears with its
// stream's first record of the segment. Numbers go on behind the highest that is there already, so
// that nothing is ever overwritten. One thread.
class RecordingFiles {
 public:
  using SteadyTime = std::chrono::steady_clock::time_point;

  // Makes the directory. Throws capture::CaptureError when that cannot be done, or nothing can be
  // made in it. A full disk is no error yet.
  explicit RecordingFiles(RecordingOptions options);

  // Throws capture::CaptureError when the record cannot be written (disk full), and
  // std::invalid_argument when no capture can hold it (see CaptureWriter).
  void write(Stream stream, const capture::Record& record, SteadyTime now);

  // Between records, about once a second: puts everything on the disk, deletes what is too much,
  // and ends the segment when it is large or old enough. Throws capture::CaptureError also when the
  // disk is nearly full.
  void maintain(SteadyTime now);
  // Ends the segment; the next record begins another.
  void close();
  // The same after a failure: keeps what is in the files, throws nothing.
  void abandon() noexcept;

  [[nodiscard]] std::uint64_t free_bytes() const;
  [[nodiscard]] std::uint64_t bytes() const noexcept;  // written since the start
  [[nodiscard]] unsigned segment() const noexcept { return segment_; }
  [[nodiscard]] std::uint64_t deleted_segments() const noexcept { return deleted_segments_; }

 private:
  [[nodiscard]] bool is_due(SteadyTime now) const noexcept;
  void prune();

  RecordingOptions options_;
  std::array<std::unique_ptr<capture::CaptureWriter>, kStreams> writers_;
  unsigned segment_ = 0;
  std::optional<SteadyTime> segment_start_;  // nothing: the segment has no file yet
  std::uint64_t closed_bytes_ = 0;
  std::uint64_t deleted_segments_ = 0;
};

}  // namespace convexcut::recorder
