// SPDX-License-Identifier: Apache-2.0
#include "daemon/sources/recording_setup.hpp"

namespace convexcut::daemon {
namespace {

// Megabytes as disks are sold.
std::uint64_t bytes_of(std::int64_t megabytes) {
  return static_cast<std::uint64_t>(megabytes) * 1'000'000U;
}

}  // namespace

recorder::RecorderOptions recorder_options(const config::Record& record) {
  recorder::RecorderOptions options;
  options.files.directory = record.directory;
  options.files.max_file_bytes = bytes_of(record.max_file_mb);
  options.files.max_file_time = std::chrono::seconds{record.max_file_s};
  options.files.keep_bytes = bytes_of(record.keep_mb);
  return options;
}

LiveTaps taps_of(recorder::Recorder& recorder) noexcept {
  return {&recorder.tap(recorder::Stream::lidar), &recorder.tap(recorder::Stream::imu),
          &recorder.tap(recorder::Stream::can)};
}

}  // namespace convexcut::daemon
