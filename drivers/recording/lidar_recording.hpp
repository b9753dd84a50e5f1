// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/return_batch.hpp"
#include "core/sink.hpp"
#include "drivers/capture/capture_reader.hpp"
#include "drivers/recording/recorded_stream.hpp"
#include "drivers/velodyne/lidar_driver.hpp"

namespace convexcut::recording {

// A capture of a lidar's network: its UDP datagrams into a LidarDriver.
class LidarRecording final : public RecordedStream {
 public:
  // Throws capture::CaptureError: missing, empty, not a capture, not a network capture.
  LidarRecording(const std::filesystem::path& file, const velodyne::LidarDriverOptions& options,
                 Sink<ReturnBatch>& sink);

  [[nodiscard]] std::optional<HostTime> next_stamp() override;
  void deliver() override;
  void finish() override { driver_.flush(); }
  [[nodiscard]] std::string problem() const override { return reader_.problem(); }
  [[nodiscard]] std::uint64_t bytes_read() const override { return reader_.bytes_read(); }
  [[nodiscard]] std::uint64_t bytes_total() const override { return reader_.file_size(); }

  [[nodiscard]] const velodyne::LidarDriver& driver() const noexcept { return driver_; }
  [[nodiscard]] const capture::CaptureReader& reader() const noexcept { return reader_; }

 private:
  capture::CaptureReader reader_;
  velodyne::LidarDriver driver_;
  capture::Record record_;
  bool have_record_ = false;
};

}  // namespace convexcut::recording
