// SPDX-License-Identifier: Apache-2.0
#include "daemon/sources/live_sources.hpp"

#include <cerrno>
#include <cstring>

#include "config/loader.hpp"
#include "daemon/sources/driver_options.hpp"
#include "drivers/xsens/error_code.hpp"

namespace convexcut::daemon {
namespace {

std::string lidar_device(const config::Lidar& lidar) {
  std::string device = "UDP ports " + std::to_string(lidar.data_port) + " and " +
                       std::to_string(lidar.position_port);
  if (!lidar.interface.empty()) device += " on " + lidar.interface;
  return device;
}

}  // namespace

LiveSources::LiveSources(const config::Config& config, Sink<ReturnBatch>& returns,
                         Sink<ImuSample>& samples, Sink<EncoderSample>& angles,
                         const LiveTaps& taps)
    : config_(config),
      lidar_driver_(lidar_driver_options(config.lidar), returns),
      lidar_(udp_source_options(config.lidar), lidar_driver_, taps.lidar) {
  entries_.push_back({"lidar", SourceRole::lidar, lidar_, lidar_device(config.lidar)});
  if (!config.imu.device.empty()) {
    imu_driver_ = std::make_unique<xsens::ImuDriver>(imu_driver_options(config.imu), samples);
    imu_ = std::make_unique<serial::SerialSource>(serial_source_options(config.imu), *imu_driver_,
                                                  taps.imu);
    entries_.push_back({"imu", SourceRole::imu, *imu_, config.imu.device});
  }
  if (!config.can.interface.empty()) add_can(config, samples, angles, taps.can);
  check_needs();
}

void LiveSources::add_can(const config::Config& config, Sink<ImuSample>& samples,
                          Sink<EncoderSample>& angles, live::RawTap* tap) {
  // One source of orientation: a serial IMU goes before one on the bus.
  Sink<ImuSample>& to = imu_ ? static_cast<Sink<ImuSample>&>(unused_samples_) : samples;
  bus_ = std::make_unique<can::BusDevices>(bus_options(config), to, angles);
  can_ = std::make_unique<socketcan::SocketCanSource>(socketcan_options(config), *bus_, tap);
  entries_.push_back({"can", SourceRole::imu, *can_, config.can.interface});
}

void LiveSources::check_needs() const {
  if (config_.mount.orientation == config::MountOrientation::imu && !imu_ && !can_) {
    throw config::ConfigError(
        "mount.orientation is \"imu\" but no IMU is configured: expected imu.device (a serial "
        "device, best one of /dev/serial/by-id) or can.interface, or a fixed mount (--set "
        "mount.orientation=fixed, with mount.roll_deg, pitch_deg and yaw_deg)");
  }
  if (config_.encoder.use != config::EncoderUse::off && !can_) {
    throw config::ConfigError(
        "encoder.use is not \"off\" but no CAN bus is configured: expected can.interface, the "
        "network interface that the encoder is on");
  }
}

std::uint64_t LiveSources::kernel_drops() const noexcept {
  const std::uint64_t frames = can_ ? can_->counters().dropped.value() : 0;
  return lidar_.counters().kernel_drops.value() + frames;
}

std::vector<std::string> LiveSources::warnings() const {
  std::vector<std::string> lines;
  for (const Entry& entry : entries_) {
    if (entry.source.link() == live::LinkState::open || entry.source.last_error() == 0) continue;
    lines.push_back(std::string(entry.name) + ": " + entry.device + ": " +
                    std::strerror(entry.source.last_error()) + "; it is tried again");
  }
  add_lidar_warnings(lines);
  add_imu_warnings(lines);
  add_can_warnings(lines);
  return lines;
}

void LiveSources::add_can_warnings(std::vector<std::string>& lines) const {
  if (!can_) return;
  const std::string where = "can: " + config_.can.interface + ": ";
  if (can_->link() == live::LinkState::closed && can_->last_error() == ENETDOWN) {
    lines.push_back(where + "to bring it up: `ip link set " + config_.can.interface +
                    " up type can bitrate " + std::to_string(config_.can.bitrate) +
                    " restart-ms 100`");
  }
  if (can_->link() == live::LinkState::closed) return;
  if (can_->controller() == can::ControllerState::bus_off) {
    lines.push_back(where +
                    "the controller is off the bus: look at the cable, the terminators and "
                    "the bit rate; without restart-ms it comes back with `ip link set " +
                    config_.can.interface + " type can restart`");
  } else if (can_->controller() == can::ControllerState::passive) {
    lines.push_back(where +
                    "the controller is error-passive: look at the cable, the terminators "
                    "and the bit rate");
  }
}

void LiveSources::add_lidar_warnings(std::vector<std::string>& lines) const {
  const std::size_t wanted = udp_source_options(config_.lidar).socket.receive_buffer_bytes;
  const std::size_t granted = lidar_.receive_buffer_bytes();
  if (granted == 0 || granted >= wanted) return;
  lines.push_back("lidar: the receive buffer is " + std::to_string(granted / 1024) +
                  " KiB instead of " + std::to_string(wanted / 1024) +
                  " KiB, packets are lost when the host is busy: allow more with `sysctl -w "
                  "net.core.rmem_max=" +
                  std::to_string(wanted) + "`");
}

void LiveSources::add_imu_warnings(std::vector<std::string>& lines) const {
  if (!imu_ || imu_->configuration() == nullptr) return;
  const xsens::MtConfiguration& device = *imu_->configuration();
  const std::string start = "imu: " + config_.imu.device + ": ";
  if (device.state() == xsens::MtState::no_answer) {
    lines.push_back(start + "does not answer at " + std::to_string(device.baud()) +
                    " bit/s; it is tried again (imu.baud is the rate of its line, imu.scan_baud "
                    "looks for it)");
  }
  if (device.outcome() == xsens::MtOutcome::refused) {
    lines.push_back(start + "refuses to send what is wanted: " +
                    std::string(xsens::describe_error(device.last_error())) +
                    "; it sends what it was set to before");
  } else if (device.outcome() == xsens::MtOutcome::differs) {
    lines.push_back(start + "sends other data or rates than it was told (imu.rate_hz)");
  }
  if (device.state() == xsens::MtState::measuring && config_.imu.baud != 0 &&
      config_.imu.set_baud != 0 && device.baud() != config_.imu.set_baud) {
    lines.push_back(start + "stays at " + std::to_string(device.baud()) + " bit/s instead of " +
                    std::to_string(config_.imu.set_baud) + ", and sends fewer samples");
  }
}

}  // namespace convexcut::daemon
