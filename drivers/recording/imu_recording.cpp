// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/imu_recording.hpp"

#include <span>

#include "drivers/recording/file_kind.hpp"

namespace convexcut::recording {
namespace {

xsens::ImuDriverOptions with_start(xsens::ImuDriverOptions options, bool stamped, HostTime start) {
  if (!stamped) options.unstamped_start = start;
  return options;
}

}  // namespace

ImuRecording::ImuRecording(const std::filesystem::path& file,
                           const xsens::ImuDriverOptions& options, HostTime unstamped_start,
                           Sink<ImuSample>& sink)
    : bytes_total_(size_of(file)),
      capture_(open_capture(
          file, capture::LinkKind::serial,
          "a serial recording (a capture of link type USER0, 147, or a raw .bin stream)")),
      raw_(capture_ ? nullptr : std::make_unique<capture::SerialLog>(file)),
      tap_(sink),
      driver_(with_start(options, stamped(), unstamped_start),
              stamped() ? static_cast<Sink<ImuSample>&>(tap_) : queue_) {}

std::optional<HostTime> ImuRecording::next_stamp() {
  if (stamped()) {
    while (!have_record_) {
      if (capture_->next(record_) != capture::ReadStatus::record) return std::nullopt;
      have_record_ = record_.kind == capture::RecordKind::serial;
    }
    return record_.stamp;
  }
  std::span<const std::byte> chunk;
  while (queue_.samples_.empty()) {
    if (raw_->next(chunk) != capture::ReadStatus::record) return std::nullopt;
    if (statistics_ != nullptr) statistics_->on_bytes(chunk);
    driver_.on_bytes(chunk, {});
  }
  return queue_.samples_.front().arrival;
}

void ImuRecording::deliver() {
  if (stamped()) {
    if (statistics_ != nullptr) statistics_->on_bytes(record_.payload);
    driver_.on_bytes(record_.payload, record_.stamp);
    have_record_ = false;
    return;
  }
  if (ImuSample* slot = tap_.claim()) {
    *slot = queue_.samples_.front();
    tap_.commit();
  }
  queue_.samples_.pop_front();
}

std::string ImuRecording::problem() const {
  return capture_ ? capture_->problem() : raw_->problem();
}

std::uint64_t ImuRecording::bytes_read() const {
  return capture_ ? capture_->bytes_read() : raw_->bytes_read();
}

std::string ImuRecording::summary() const {
  const xsens::ImuCounters& c = counters();
  return std::to_string(c.xbus.frames.value()) + " Xbus frames (" +
         std::to_string(c.data_messages.value()) + " MTData2), " +
         std::to_string(c.xbus.checksum_errors.value()) + " checksum errors, " +
         std::to_string(c.xbus.skipped_bytes.value()) + " bytes outside frames, " +
         std::to_string(c.no_device_time.value()) + " samples without device time";
}

}  // namespace convexcut::recording
