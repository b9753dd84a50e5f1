// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/lidar_driver.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <span>

#include "drivers/velodyne/data_packet.hpp"

namespace convexcut::velodyne {
namespace {

std::uint32_t micros_modulo_hour(Duration offset) noexcept {
  constexpr std::int64_t kHourUs = wire_layout::kMicrosPerHour;
  const std::int64_t micros = std::chrono::round<std::chrono::microseconds>(offset).count();
  return static_cast<std::uint32_t>((micros % kHourUs + kHourUs) % kHourUs);
}

}  // namespace

LidarDriver::LidarDriver(const LidarDriverOptions& options, Sink<ReturnBatch>& sink) noexcept
    : options_(options), sink_(sink), time_offset_us_(micros_modulo_hour(options.time_offset)) {
  if (options_.model) set_model(*options_.model);
}

void LidarDriver::on_datagram(wire::Bytes payload, std::uint16_t destination_port, HostTime arrival,
                              Ipv4Address source) noexcept {
  const bool expected_sender = !options_.from || source == *options_.from;
  if (expected_sender && destination_port == options_.data_port) {
    on_data(payload, arrival);
  } else if (expected_sender && destination_port == options_.position_port) {
    on_position(payload);
  } else {
    counters_.foreign.add();
  }
}

void LidarDriver::flush() noexcept {
  if (held_count_ != 0) release_held(detector_.conclude());
}

std::optional<ModelId> LidarDriver::model() const noexcept {
  const int id = model_.load(std::memory_order_relaxed);  // a value on its own: orders nothing
  if (id < 0) return std::nullopt;
  return static_cast<ModelId>(id);
}

void LidarDriver::on_data(wire::Bytes payload, HostTime arrival) noexcept {
  const DecodeStatus status = check_data_packet(payload);
  if (status != DecodeStatus::ok) {
    count_rejected(status);
  } else if (decoder_) {
    decode(payload, arrival, pps());
  } else {
    hold(payload, arrival);
  }
}

void LidarDriver::on_position(wire::Bytes payload) noexcept {
  PositionPacket packet;
  switch (decode_position_packet(payload, packet)) {
    case PositionStatus::ok:
      break;
    case PositionStatus::wrong_length:
      return counters_.wrong_length.add();
    case PositionStatus::no_sentence:
      return counters_.no_sentence.add();
    case PositionStatus::timestamp_out_of_range:
      return counters_.timestamp_out_of_range.add();
  }
  counters_.position_packets.add();
  if (packet.nmea_status == NmeaStatus::malformed ||
      packet.nmea_status == NmeaStatus::bad_checksum) {
    counters_.bad_nmea.add();
  }
  position_ = packet;
}

void LidarDriver::count_rejected(DecodeStatus status) noexcept {
  switch (status) {
    case DecodeStatus::ok:
      return;
    case DecodeStatus::wrong_length:
      return counters_.wrong_length.add();
    case DecodeStatus::wrong_block_flag:
      return counters_.wrong_block_flag.add();
    case DecodeStatus::azimuth_out_of_range:
      return counters_.azimuth_out_of_range.add();
    case DecodeStatus::timestamp_out_of_range:
      return counters_.timestamp_out_of_range.add();
  }
}

void LidarDriver::hold(wire::Bytes payload, HostTime arrival) noexcept {
  Held& held = held_[held_count_++];
  std::ranges::copy(payload, held.payload.begin());
  held.arrival = arrival;
  held.pps = pps();
  const std::optional<ModelId> model = detector_.observe(payload);
  if (model) {
    release_held(model);
  } else if (held_count_ == held_.size()) {
    release_held(detector_.conclude());
  }
}

void LidarDriver::release_held(std::optional<ModelId> model) noexcept {
  if (model) {
    set_model(*model);
    for (const Held& held : std::span(held_).first(held_count_)) {
      decode(held.payload, held.arrival, held.pps);
    }
  } else {
    counters_.model_unknown.add(held_count_);
    detector_ = ModelDetector{};
  }
  held_count_ = 0;
}

void LidarDriver::set_model(ModelId id) noexcept {
  decoder_.emplace(model_of(id), DecoderOptions{.vertical_offsets = options_.vertical_offsets});
  model_.store(static_cast<int>(id), std::memory_order_relaxed);  // pairs with model()
}

void LidarDriver::decode(wire::Bytes payload, HostTime arrival, PpsState pps) noexcept {
  ReturnBatch* batch = sink_.claim();
  if (batch == nullptr) return counters_.sink_full.add();
  [[maybe_unused]] const DecodeStatus status = decoder_->decode(payload, arrival, *batch);
  assert(status == DecodeStatus::ok);  // checked on arrival
  batch->pps = pps;
  batch->first_firing = {static_cast<std::uint32_t>(
      (std::uint64_t{batch->first_firing.count} + time_offset_us_) % wire_layout::kMicrosPerHour)};
  counters_.data_packets.add();
  counters_.returns.add(batch->return_count);
  if (product(payload) != decoder_->model().product) counters_.product_differs.add();
  sink_.commit();
}

PpsState LidarDriver::pps() const noexcept {
  return position_ ? position_->pps : PpsState::unknown;
}

}  // namespace convexcut::velodyne
