// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/can_imu_driver.hpp"

#include "drivers/can/controller_state.hpp"

namespace convexcut::can {
namespace {

template <class... Messages>
constexpr std::uint32_t mask_of(Messages... messages) noexcept {
  return (XsensCanData::bit(messages) | ...);
}

// Sent about a group, ahead of its data.
constexpr std::uint32_t kHeader =
    mask_of(XsensMessage::sample_time, XsensMessage::group_counter, XsensMessage::utc_time);
constexpr std::uint32_t kReports = mask_of(XsensMessage::error, XsensMessage::warning);
// Sent between the groups at a rate of its own (1 kHz).
constexpr std::uint32_t kHighRate =
    mask_of(XsensMessage::rate_of_turn_hr, XsensMessage::acceleration_hr);
// What an ImuSample is made of.
constexpr std::uint32_t kSample =
    mask_of(XsensMessage::sample_time, XsensMessage::group_counter, XsensMessage::status_word,
            XsensMessage::quaternion, XsensMessage::euler_angles, XsensMessage::rate_of_turn,
            XsensMessage::acceleration);

constexpr bool is_in(XsensMessage message, std::uint32_t mask) noexcept {
  return (XsensCanData::bit(message) & mask) != 0;
}

}  // namespace

std::vector<CanId> received_ids(const XsensCanIds& ids) {
  std::vector<CanId> received;
  for (std::size_t i = 0; i < kXsensMessageCount; ++i) {
    if (!is_in(static_cast<XsensMessage>(i), kSample | kReports)) continue;
    received.push_back({ids.ids[i], ids.extended});
  }
  return received;
}

CanImuDriver::CanImuDriver(const CanImuOptions& options, Sink<ImuSample>& sink) noexcept
    : options_(options), sink_(sink) {}

void CanImuDriver::on_frame(const CanFrame& frame) noexcept {
  counters_.frames.add();
  if (frame.error) return count_error_frame(frame);
  if (frame.remote) return counters_.remote_frames.add();
  const std::optional<XsensMessage> message = options_.ids.find(frame);
  if (!message) return counters_.foreign_frames.add();
  if (frame.length < expected_length(*message)) return counters_.short_frames.add();
  if (is_in(*message, kReports)) {
    XsensCanData report;
    if (decode_xsens(*message, frame, report)) on_report(*message, report);
    return;
  }
  on_message(*message, frame);
}

void CanImuDriver::count_error_frame(const CanFrame& frame) noexcept {
  counters_.error_frames.add();
  if ((frame.id & kBusOff) != 0) counters_.bus_off.add();
}

void CanImuDriver::on_report(XsensMessage message, const XsensCanData& data) noexcept {
  if (message == XsensMessage::warning) return counters_.device_warnings.add();
  counters_.device_errors.add();
  // Relaxed: a lone value that orders nothing; pairs with the readers' relaxed loads.
  counters_.last_error.store(data.error, std::memory_order_relaxed);
}

void CanImuDriver::on_message(XsensMessage message, const CanFrame& frame) noexcept {
  if (group_ && begins_group(message, frame.stamp)) flush();
  if (!group_) {
    if (is_in(message, kHighRate)) return counters_.stray_frames.add();
    group_.emplace();
    group_->first_stamp = frame.stamp;
    group_->arrival = frame.stamp - bus_time(frame, options_.bitrate);
    counters_.groups.add();
  }
  if (!decode_xsens(message, frame, group_->data)) return;
  if (message == XsensMessage::sample_time) {
    group_->device_time = clock_.unwrap(group_->data.sample_time_us);
  }
  if (message == XsensMessage::group_counter) {
    loss_.on_count(group_->data.measurement.packet_counter);
  }
  if (group_->emitted) {
    if (is_in(message, kSample)) counters_.late_frames.add();
  } else if (is_complete()) {
    emit();
  }
}

bool CanImuDriver::begins_group(XsensMessage message, HostTime stamp) const noexcept {
  const Duration age = stamp - group_->first_stamp;
  if (age > options_.group_timeout || age < -options_.group_timeout) return true;
  const XsensCanData& data = group_->data;
  const bool has_body = (data.messages & ~(kHeader | kHighRate)) != 0;
  switch (message) {
    case XsensMessage::sample_time:
      return data.has(message) || has_body;
    case XsensMessage::group_counter:  // also behind the data, where SampleTime came first
      return data.has(message) || (has_body && !data.has(XsensMessage::sample_time));
    case XsensMessage::rate_of_turn_hr:
    case XsensMessage::acceleration_hr:
      return false;
    default:
      return data.has(message);
  }
}

bool CanImuDriver::is_complete() const noexcept {
  // Of two groups: one that has lost a frame does not make the next one lose it, too.
  const std::uint32_t expected = last_messages_ | last_but_one_messages_;
  return xsens::makes_sample(group_->data.measurement) &&
         (group_->data.messages & expected) == expected && expected != 0;
}

void CanImuDriver::flush() noexcept {
  if (!group_) return;
  if (!group_->emitted) emit();
  last_but_one_messages_ = last_messages_;
  last_messages_ = group_->data.messages & kSample;
  group_.reset();
}

void CanImuDriver::emit() noexcept {
  group_->emitted = true;
  const xsens::MtMeasurement& m = group_->data.measurement;
  if (!xsens::makes_sample(m)) return counters_.groups_without_inertial.add();
  if (!group_->device_time) counters_.groups_without_time.add();
  ImuSample* const sample = sink_.claim();
  if (sample == nullptr) return counters_.sink_full.add();
  xsens::fill_sample(m, *sample, counters_.values);
  sample->arrival = group_->arrival;
  sample->has_device_time = group_->device_time.has_value();
  sample->device_time = group_->device_time.value_or(ImuTime{});
  sink_.commit();
  counters_.samples.add();
}

}  // namespace convexcut::can
