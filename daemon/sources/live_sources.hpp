// SPDX-License-Identifier: Apache-2.0
//
// The live sources, joined to the drivers as a configuration asks; the counterpart of Recordings.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "config/config.hpp"
#include "core/encoder_sample.hpp"
#include "core/imu_sample.hpp"
#include "core/return_batch.hpp"
#include "core/sink.hpp"
#include "daemon/sources/null_sink.hpp"
#include "drivers/can/bus_devices.hpp"
#include "drivers/live/live_source.hpp"
#include "drivers/live/raw_tap.hpp"
#include "drivers/serial/serial_source.hpp"
#include "drivers/socketcan/socketcan_source.hpp"
#include "drivers/udp/udp_source.hpp"
#include "drivers/velodyne/lidar_driver.hpp"
#include "drivers/xsens/imu_driver.hpp"

namespace convexcut::daemon {

enum class SourceRole : std::uint8_t { lidar, imu };

// Who hears the raw records of each source; null: nobody. They outlive the sources.
struct LiveTaps {
  live::RawTap* lidar = nullptr;
  live::RawTap* imu = nullptr;
  live::RawTap* can = nullptr;
};

class LiveSources {
 public:
  struct Entry {
    std::string_view name;  // "lidar", "imu", "can": of its thread, its topic, its log lines
    SourceRole role;
    live::LiveSource& source;
    std::string device;  // for people: "UDP ports 2368 and 8308", "/dev/ttyUSB0"
  };

  // Opens nothing: that is done by the receive threads, again and again. Throws config::ConfigError
  // when the configuration asks for what cannot be: an orientation without an IMU, an encoder
  // without a bus, a rate that serial lines do not have. The sinks outlive the sources. Of two IMUs
  // the serial one gives the samples.
  LiveSources(const config::Config& config, Sink<ReturnBatch>& returns, Sink<ImuSample>& samples,
              Sink<EncoderSample>& angles, const LiveTaps& taps = {});
  LiveSources(const LiveSources&) = delete;
  LiveSources& operator=(const LiveSources&) = delete;

  // One a receive thread: the lidar's, then the others'.
  [[nodiscard]] const std::vector<Entry>& entries() const noexcept { return entries_; }

  [[nodiscard]] const velodyne::LidarDriver& lidar_driver() const noexcept { return lidar_driver_; }
  [[nodiscard]] const udp::UdpSource& lidar() const noexcept { return lidar_; }
  // Null when no serial IMU is configured.
  [[nodiscard]] const xsens::ImuDriver* imu_driver() const noexcept { return imu_driver_.get(); }
  [[nodiscard]] const serial::SerialSource* imu() const noexcept { return imu_.get(); }
  // Null when no bus is configured.
  [[nodiscard]] const can::BusDevices* bus() const noexcept { return bus_.get(); }
  [[nodiscard]] const socketcan::SocketCanSource* can() const noexcept { return can_.get(); }

  // Losses of all sources that neither their drivers nor the sinks count: datagrams and frames that
  // the kernel dropped.
  [[nodiscard]] std::uint64_t kernel_drops() const noexcept;

  // What is amiss now, one line each with what to do about it: a link that cannot be opened, a
  // receive buffer that the kernel cut, an IMU that does not answer or refuses what it is told. Any
  // thread; allocates.
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  void add_can(const config::Config& config, Sink<ImuSample>& samples, Sink<EncoderSample>& angles,
               live::RawTap* tap);
  void check_needs() const;
  void add_can_warnings(std::vector<std::string>& lines) const;
  void add_lidar_warnings(std::vector<std::string>& lines) const;
  void add_imu_warnings(std::vector<std::string>& lines) const;

  config::Config config_;
  velodyne::LidarDriver lidar_driver_;
  udp::UdpSource lidar_;
  std::unique_ptr<xsens::ImuDriver> imu_driver_;
  std::unique_ptr<serial::SerialSource> imu_;
  NullSink<ImuSample> unused_samples_;
  std::unique_ptr<can::BusDevices> bus_;
  std::unique_ptr<socketcan::SocketCanSource> can_;
  std::vector<Entry> entries_;
};

}  // namespace convexcut::daemon
