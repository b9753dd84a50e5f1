// SPDX-License-Identifier: Apache-2.0
#include "drivers/can/bus_devices.hpp"

namespace convexcut::can {

std::vector<CanId> received_ids(const BusOptions& options) {
  std::vector<CanId> ids = received_ids(options.imu.ids);
  if (options.encoder) ids.push_back(options.encoder->id);
  return ids;
}

BusDevices::BusDevices(const BusOptions& options, Sink<ImuSample>& samples,
                       Sink<EncoderSample>& angles)
    : imu_(options.imu, samples) {
  if (options.encoder) encoder_.emplace(*options.encoder, angles);
}

void BusDevices::on_frame(const CanFrame& frame) noexcept {
  if (encoder_ && has_id(frame, encoder_->id())) {
    encoder_->on_frame(frame);
  } else {
    imu_.on_frame(frame);
  }
}

}  // namespace convexcut::can
