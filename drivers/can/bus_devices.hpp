// SPDX-License-Identifier: Apache-2.0
//
// What is on one bus: an IMU, and the encoder of a stage where there is one.
#pragma once

#include <optional>
#include <vector>

#include "core/encoder_sample.hpp"
#include "core/imu_sample.hpp"
#include "core/sink.hpp"
#include "drivers/can/can_imu_driver.hpp"
#include "drivers/can/encoder_driver.hpp"
#include "drivers/can/frame_receiver.hpp"

namespace convexcut::can {

struct BusOptions {
  CanImuOptions imu{};
  std::optional<EncoderOptions> encoder;  // none: there is none, or it is not used
};

// All identifiers of the devices: what a socket has to let through.
[[nodiscard]] std::vector<CanId> received_ids(const BusOptions& options);

// Gives each frame to the device that sent it; the controller's reports go to the IMU's driver,
// which counts them. Threads and RT as for the drivers.
class BusDevices final : public FrameReceiver {
 public:
  // The sinks outlive the devices. Throws what EncoderDriver throws.
  BusDevices(const BusOptions& options, Sink<ImuSample>& samples, Sink<EncoderSample>& angles);

  void on_frame(const CanFrame& frame) noexcept override;
  void flush() noexcept override { imu_.flush(); }

  [[nodiscard]] const CanImuDriver& imu() const noexcept { return imu_; }
  [[nodiscard]] const EncoderDriver* encoder() const noexcept {
    return encoder_ ? &*encoder_ : nullptr;
  }

 private:
  CanImuDriver imu_;
  std::optional<EncoderDriver> encoder_;
};

}  // namespace convexcut::can
