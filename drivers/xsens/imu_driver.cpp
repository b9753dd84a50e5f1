// SPDX-License-Identifier: Apache-2.0
#include "drivers/xsens/imu_driver.hpp"

#include "drivers/xsens/sample_time.hpp"

namespace convexcut::xsens {

ImuDriver::ImuDriver(const ImuDriverOptions& options, Sink<ImuSample>& sink) noexcept
    : options_(options), sink_(sink) {}

void ImuDriver::on_bytes(wire::Bytes bytes, HostTime stamp) noexcept {
  framer_.feed(bytes, [&](const XbusFrame& frame) noexcept { on_frame(frame, stamp); });
}

void ImuDriver::on_frame(const XbusFrame& frame, HostTime stamp) noexcept {
  if (observer_ != nullptr) observer_->on_frame(frame);
  switch (static_cast<MessageId>(frame.message_id)) {
    case MessageId::mtdata2:
      counters_.data_messages.add();
      on_data(frame, stamp);
      return;
    case MessageId::error:
      counters_.error_messages.add();
      // Relaxed: a lone value that orders nothing; pairs with the readers' relaxed loads.
      if (!frame.payload.empty()) {
        counters_.last_error.store(wire::load_u8(frame.payload, 0), std::memory_order_relaxed);
      }
      return;
    default:
      counters_.other_messages.add();
      return;
  }
}

void ImuDriver::on_data(const XbusFrame& frame, HostTime stamp) noexcept {
  MtMeasurement m;
  switch (parse_mtdata2(frame.payload, m)) {
    case PayloadStatus::truncated:
      counters_.truncated_payloads.add();
      return;
    case PayloadStatus::wrong_size:
      counters_.wrong_item_sizes.add();
      return;
    case PayloadStatus::ok:
      break;
  }
  if (m.has(MtItem::packet_counter)) loss_.on_count(m.packet_counter);
  // Every message moves the clock, also those that make no sample: no wrap goes unseen.
  std::optional<ImuTime> device_time;
  if (const auto ticks = sample_time_ticks(m)) device_time = clock_.unwrap(*ticks);
  if (!makes_sample(m)) {
    counters_.without_inertial.add();
    return;
  }
  emit(m, device_time, stamp - line_time(frame.bytes_behind + frame.size, options_.baud));
}

void ImuDriver::emit(const MtMeasurement& m, std::optional<ImuTime> device_time,
                     HostTime arrival) noexcept {
  if (options_.unstamped_start) {
    if (!device_time) {
      counters_.no_device_time.add();
      return;
    }
    arrival = unstamped_arrival(*device_time);
  }
  ImuSample* const sample = sink_.claim();
  if (sample == nullptr) {
    counters_.sink_full.add();
    return;
  }
  fill_sample(m, *sample, counters_.values);
  sample->arrival = arrival;
  sample->has_device_time = device_time.has_value();
  sample->device_time = device_time.value_or(ImuTime{});
  sink_.commit();
  counters_.samples.add();
}

HostTime ImuDriver::unstamped_arrival(ImuTime device_time) noexcept {
  if (!first_device_time_) first_device_time_ = device_time;
  return *options_.unstamped_start + (device_time - *first_device_time_);
}

}  // namespace convexcut::xsens
