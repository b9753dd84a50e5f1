// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/encoder_driver.hpp"

#include <stdexcept>

namespace convexcut::can {
namespace {

[[nodiscard]] std::size_t checked_length(const Signal& signal) {
  const auto length = needed_length(signal);
  if (!length) throw std::invalid_argument("the encoder's signal fits no CAN frame");
  return *length;
}

}  // namespace

EncoderDriver::EncoderDriver(const EncoderOptions& options, Sink<EncoderSample>& sink)
    : options_(options), needed_length_(checked_length(options.signal)), sink_(sink) {}

void EncoderDriver::on_frame(const CanFrame& frame) noexcept {
  if (!has_id(frame, options_.id)) return;
  counters_.frames.add();
  if (frame.remote) return counters_.remote_frames.add();
  if (!has_prefix(options_.signal, frame.payload())) return counters_.other_signals.add();
  if (frame.length < needed_length_) return counters_.short_frames.add();
  EncoderSample* const sample = sink_.claim();
  if (sample == nullptr) return counters_.sink_full.add();
  sample->arrival = frame.stamp - bus_time(frame, options_.bitrate);
  sample->angle = Degrees{value_of(options_.signal, frame.payload())}.to_radians();
  sink_.commit();
  counters_.samples.add();
}

}  // namespace convexcut::can
