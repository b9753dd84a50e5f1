// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/imu_sample.hpp"
#include "core/sink.hpp"
#include "drivers/capture/capture_reader.hpp"
#include "drivers/capture/serial_log.hpp"
#include "drivers/recording/recorded_stream.hpp"
#include "drivers/recording/sample_tap.hpp"
#include "drivers/xsens/imu_driver.hpp"
#include "drivers/xsens/mt_statistics.hpp"

namespace convexcut::recording {

// A recorded serial line of an MTi: a capture of stamped reads (link type USER0), or a raw stream
// without stamps, whose samples are placed by the device's own time.
class ImuRecording final : public RecordedStream {
 public:
  // Tells the two kinds by their first bytes. `unstamped_start`: when the first sample of a raw
  // stream was taken. Throws capture::CaptureError: missing, empty, a capture of something else.
  ImuRecording(const std::filesystem::path& file, const xsens::ImuDriverOptions& options,
               HostTime unstamped_start, Sink<ImuSample>& sink);

  [[nodiscard]] std::optional<HostTime> next_stamp() override;
  void deliver() override;
  void finish() override {}
  [[nodiscard]] std::string problem() const override;
  [[nodiscard]] std::uint64_t bytes_read() const override;
  [[nodiscard]] std::uint64_t bytes_total() const override { return bytes_total_; }

  // Shows every byte to `statistics` as well; before the first record. It outlives the recording's
  // use.
  void inspect(xsens::MtStatistics& statistics) noexcept { statistics_ = &statistics; }

  [[nodiscard]] bool stamped() const noexcept { return capture_ != nullptr; }
  [[nodiscard]] std::uint64_t orientations() const noexcept { return tap_.orientations(); }
  [[nodiscard]] const xsens::ImuCounters& counters() const noexcept { return driver_.counters(); }
  // What was found, for messages to people: "100 messages, 0 checksum errors, …".
  [[nodiscard]] std::string summary() const;

 private:
  // Samples of a raw stream that are decoded but whose time has not come.
  class Queue final : public Sink<ImuSample> {
   public:
    [[nodiscard]] ImuSample* claim() noexcept override { return &sample_; }
    void commit() noexcept override { samples_.push_back(sample_); }
    std::deque<ImuSample> samples_;

   private:
    ImuSample sample_;
  };

  std::uint64_t bytes_total_;
  std::unique_ptr<capture::CaptureReader> capture_;  // one of the two
  std::unique_ptr<capture::SerialLog> raw_;
  SampleTap tap_;
  Queue queue_;
  xsens::ImuDriver driver_;
  capture::Record record_;
  bool have_record_ = false;
  xsens::MtStatistics* statistics_ = nullptr;
};

}  // namespace convexcut::recording
