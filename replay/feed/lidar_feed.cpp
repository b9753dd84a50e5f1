// SPDX-License-Identifier: Apache-2.0
#include "replay/feed/lidar_feed.hpp"

#include <chrono>
#include <utility>

#include "drivers/velodyne/wire_layout.hpp"

namespace convexcut::replay {

namespace layout = velodyne::wire_layout;

namespace {

constexpr std::int64_t kHourUs = layout::kMicrosPerHour;

// From one time past the hour to another, the shorter way around.
Duration step_between(std::uint32_t from_us, std::uint32_t to_us) {
  std::int64_t step = (std::int64_t{to_us} - from_us) % kHourUs;
  if (step > kHourUs / 2) step -= kHourUs;
  if (step < -kHourUs / 2) step += kHourUs;
  return std::chrono::microseconds{step};
}

}  // namespace

LidarFeed::LidarFeed(LidarFeedOptions options, DatagramLink& link)
    : options_(std::move(options)), link_(link) {
  rewind();
}

void LidarFeed::rewind() {
  reader_ = std::make_unique<capture::CaptureReader>(options_.file);
  if (reader_->link() == capture::LinkKind::serial || reader_->link() == capture::LinkKind::can) {
    throw capture::CaptureError(options_.file.string() +
                                ": expected a network capture with lidar packets, found a "
                                "recording of a serial line or a CAN bus");
  }
  have_record_ = false;
  newest_us_.reset();
  gained_ = {};
}

std::optional<HostTime> LidarFeed::next_stamp() {
  while (!have_record_) {
    if (reader_->next(record_) != capture::ReadStatus::record) return std::nullopt;
    if (record_.kind != capture::RecordKind::datagram) continue;
    port_ = port_of(record_);
    have_record_ = port_ != 0;
    if (!have_record_) ++foreign_;
  }
  return record_.stamp;
}

// The recorded sensor may have sent to other ports than this one shall.
std::uint16_t LidarFeed::port_of(const capture::Record& record) const noexcept {
  if (record.payload.size() == layout::kDataPacketSize) return options_.data_port;
  if (record.payload.size() == layout::kPositionPacketSize) return options_.position_port;
  if (record.destination_port == layout::kDataPort) return options_.data_port;
  if (record.destination_port == layout::kPositionPort) return options_.position_port;
  return 0;
}

void LidarFeed::send(const PlayedTime& time) {
  payload_.assign(record_.payload.begin(), record_.payload.end());
  if (payload_.size() == layout::kDataPacketSize) {
    move_time(layout::kDataTimestamp, time);
  } else if (payload_.size() == layout::kPositionPacketSize) {
    move_time(layout::kPositionTimestamp, time);
  }
  ++(port_ == options_.data_port ? data_packets_ : position_packets_);
  link_.send(live::Steady::now(), port_, payload_);
  have_record_ = false;
}

void LidarFeed::move_time(std::size_t offset, const PlayedTime& time) {
  const auto recorded = wire::load_le<std::uint32_t>(payload_, offset);
  if (recorded > layout::kMaxTimestamp) return;  // garbage stays garbage
  if (newest_us_) {
    const Duration step = step_between(*newest_us_, recorded);
    gained_ += step;
    const bool shortest = packet_interval_ == Duration{0} || step < packet_interval_;
    if (offset == layout::kDataTimestamp && step > Duration{0} && shortest) {
      packet_interval_ = step;
    }
  }
  newest_us_ = recorded;
  const auto shift = std::chrono::duration_cast<std::chrono::microseconds>(time.shift(gained_));
  if (shift.count() == 0) return;  // byte by byte as recorded
  const std::int64_t moved = (recorded + shift.count()) % kHourUs;
  wire::store_le<std::uint32_t>(payload_, offset,
                                static_cast<std::uint32_t>((moved + kHourUs) % kHourUs));
}

}  // namespace convexcut::replay
