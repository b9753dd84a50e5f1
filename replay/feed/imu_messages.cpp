// SPDX-License-Identifier: Apache-2.0
#include "replay/feed/imu_messages.hpp"

#include <span>

#include "drivers/recording/file_kind.hpp"
#include "drivers/xsens/mtdata2.hpp"
#include "drivers/xsens/sample_time.hpp"

namespace convexcut::replay {
namespace {

using xsens::MessageId;

bool is_sent_while_measuring(std::uint8_t message_id) {
  const auto message = static_cast<MessageId>(message_id);
  return message == MessageId::mtdata2 || message == MessageId::error ||
         message == MessageId::warning;
}

// The framer gives the payload, which lies in the frame.
wire::Bytes whole(const xsens::XbusFrame& frame) {
  const std::size_t header = frame.size - frame.payload.size() - xsens::kChecksumSize;
  return {frame.payload.data() - header, frame.size};
}

}  // namespace

ImuMessages::ImuMessages(const std::filesystem::path& file, HostTime unstamped_start)
    : capture_(recording::open_capture(file, capture::LinkKind::serial,
                                       "a serial recording (a capture of link type USER0, 147, or "
                                       "a raw .bin stream)")),
      raw_(capture_ ? nullptr : std::make_unique<capture::SerialLog>(file)),
      unstamped_start_(unstamped_start),
      latest_(unstamped_start) {}

const ImuMessage* ImuMessages::front() {
  while (queue_.empty()) {
    if (!read()) return nullptr;
  }
  return &queue_.front();
}

bool ImuMessages::read() {
  if (raw_) {
    std::span<const std::byte> chunk;
    if (raw_->next(chunk) != capture::ReadStatus::record) return false;
    framer_.feed(chunk, [&](const xsens::XbusFrame& frame) { on_frame(frame, unstamped(frame)); });
    return true;
  }
  capture::Record record;
  if (capture_->next(record) != capture::ReadStatus::record) return false;
  if (record.kind != capture::RecordKind::serial) return true;
  framer_.feed(record.payload,
               [&](const xsens::XbusFrame& frame) { on_frame(frame, record.stamp); });
  return true;
}

void ImuMessages::on_frame(const xsens::XbusFrame& frame, HostTime stamp) {
  if (!is_sent_while_measuring(frame.message_id)) return;
  const wire::Bytes bytes = whole(frame);
  queue_.push_back({stamp, {bytes.begin(), bytes.end()}});
}

HostTime ImuMessages::unstamped(const xsens::XbusFrame& frame) {
  xsens::MtMeasurement m;
  if (static_cast<MessageId>(frame.message_id) != MessageId::mtdata2 ||
      xsens::parse_mtdata2(frame.payload, m) != xsens::PayloadStatus::ok) {
    return latest_;
  }
  if (const auto ticks = xsens::sample_time_ticks(m)) {
    const ImuTime time = clock_.unwrap(*ticks);
    if (!first_time_) first_time_ = time;
    latest_ = unstamped_start_ + (time - *first_time_);
  }
  return latest_;
}

}  // namespace convexcut::replay
