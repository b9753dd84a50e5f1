// SPDX-License-Identifier: Apache-2.0
#include "daemon/sources/driver_options.hpp"

#include <string>

#include "config/conflicts.hpp"
#include "config/loader.hpp"
#include "config/text_rules.hpp"

namespace convexcut::daemon {
namespace {

[[nodiscard]] std::optional<velodyne::ModelId> model_id(config::LidarModel model) {
  switch (model) {
    case config::LidarModel::automatic:
      return std::nullopt;
    case config::LidarModel::hdl32e:
      return velodyne::ModelId::hdl32e;
    case config::LidarModel::vlp16:
      return velodyne::ModelId::vlp16;
    case config::LidarModel::puck_hires:
      return velodyne::ModelId::puck_hires;
    case config::LidarModel::vlp32c:
      return velodyne::ModelId::vlp32c;
  }
  return std::nullopt;
}

// An IPv4 address that the configuration has checked; nothing for an empty one.
[[nodiscard]] std::optional<Ipv4Address> address(const std::string& text) {
  const auto value = config::parse_ipv4(text);
  if (!value) return std::nullopt;
  return Ipv4Address{*value};
}

void require_baud(const char* key, std::uint32_t baud) {
  if (baud == 0 || serial::is_supported(baud)) return;
  std::string rates;
  for (const std::uint32_t rate : serial::supported_bauds()) {
    rates += (rates.empty() ? "" : ", ") + std::to_string(rate);
  }
  throw config::ConfigError(std::string(key) + ": expected 0 or one of " + rates + ", found " +
                            std::to_string(baud));
}

[[nodiscard]] can::Signal layout(const config::Encoder& encoder) {
  switch (encoder.preset) {
    case config::EncoderPreset::cia402_position:
      return can::cia402_position();
    case config::EncoderPreset::cia402_position_sdo:
      return can::cia402_position_sdo();
    case config::EncoderPreset::none:
      break;
  }
  can::Signal signal;
  signal.order = encoder.byte_order == config::ByteOrder::intel ? can::ByteOrder::intel
                                                                : can::ByteOrder::motorola;
  signal.start_bit = encoder.start_bit;
  signal.length = encoder.length_bits;
  signal.is_signed = encoder.is_signed;
  return signal;
}

[[nodiscard]] can::EncoderOptions encoder_options(const config::Encoder& encoder,
                                                  std::uint32_t bitrate) {
  can::EncoderOptions options;
  options.id = {encoder.id, encoder.extended_id};
  options.signal = layout(encoder);
  options.signal.scale = encoder.scale_deg;
  options.signal.offset = encoder.offset.value;
  options.bitrate = bitrate;
  return options;
}

}  // namespace

velodyne::LidarDriverOptions lidar_driver_options(const config::Lidar& lidar) {
  velodyne::LidarDriverOptions options;
  options.model = model_id(lidar.model);
  options.data_port = lidar.data_port;
  options.position_port = lidar.position_port;
  options.vertical_offsets = lidar.vertical_offsets;
  options.from = address(lidar.source_address);
  options.time_offset = std::chrono::microseconds{lidar.time_offset_us};
  return options;
}

xsens::ImuDriverOptions imu_driver_options(const config::Imu& imu) {
  xsens::ImuDriverOptions options;
  options.baud = imu.baud;
  return options;
}

can::CanImuOptions can_driver_options(const config::Can& settings) {
  using Message = can::XsensMessage;
  can::CanImuOptions options;
  options.bitrate = settings.bitrate;
  options.ids[Message::sample_time] = settings.sample_time_id;
  options.ids[Message::group_counter] = settings.group_counter_id;
  options.ids[Message::status_word] = settings.status_id;
  options.ids[Message::quaternion] = settings.quaternion_id;
  options.ids[Message::euler_angles] = settings.euler_id;
  options.ids[Message::rate_of_turn] = settings.rate_of_turn_id;
  options.ids[Message::acceleration] = settings.acceleration_id;
  options.ids.extended = settings.extended_ids;
  return options;
}

udp::UdpSourceOptions udp_source_options(const config::Lidar& lidar) {
  constexpr std::size_t kKib = 1024;
  udp::UdpSourceOptions options;
  options.data_port = lidar.data_port;
  options.position_port = lidar.position_port;
  options.socket.local_address = address(lidar.local_address);
  options.socket.multicast_group = address(lidar.multicast_group);
  options.socket.interface = lidar.interface;
  options.gather = std::chrono::microseconds{lidar.gather_us};
  options.socket.receive_buffer_bytes = static_cast<std::size_t>(lidar.receive_buffer_kib) * kKib;
  return options;
}

serial::SerialSourceOptions serial_source_options(const config::Imu& imu) {
  require_baud("imu.baud", imu.baud);
  require_baud("imu.set_baud", imu.set_baud);
  serial::SerialSourceOptions options;
  options.device = imu.device;
  options.baud = imu.baud;
  if (imu.configure) {
    options.configuration = {.baud = imu.baud,
                             .set_baud = imu.set_baud,
                             .scan_baud = imu.scan_baud,
                             .rate_hz = static_cast<std::uint16_t>(imu.rate_hz)};
  }
  return options;
}

can::BusOptions bus_options(const config::Config& config) {
  can::BusOptions options{.imu = can_driver_options(config.can), .encoder = std::nullopt};
  if (config.encoder.use != config::EncoderUse::off) {
    options.encoder = encoder_options(config.encoder, config.can.bitrate);
  }
  return options;
}

socketcan::SocketCanOptions socketcan_options(const config::Config& config) {
  const can::BusOptions devices = bus_options(config);
  return {.interface = config.can.interface,
          .ids = can::received_ids(devices),
          .idle = devices.imu.group_timeout};
}

// The configuration's check of the line is made for these messages.
static_assert(config::kConfiguredMessageBytes == xsens::mt_message_size());

}  // namespace convexcut::daemon
