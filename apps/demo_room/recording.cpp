// SPDX-License-Identifier: Apache-2.0
#include "apps/demo_room/recording.hpp"

#include <span>
#include <stdexcept>
#include <string>

#include <system_error>

#include "drivers/capture/capture_writer.hpp"
#include "drivers/ipv4_address.hpp"
#include "replay/atomic_file.hpp"

namespace convexcut::sim {
namespace {

// Sunday 2026-03-01 09:59:58 UTC: the hour, where the lidar's counter wraps, comes 2 s later.
constexpr HostTime kStart = from_ns<HostTime>(1'772'359'198'000'000'000);
// Without PPS the counter runs from power-on.
constexpr Duration kRunningFor = std::chrono::milliseconds{754'321};

// From the end of a packet to the host's stamp: the line (1248 bytes at 100 Mbit/s), then the host.
constexpr Duration kDataDelay = std::chrono::microseconds{105};
constexpr double kJitterNs = 40e3;
// A position packet follows every ninth data packet: 201 a second, as measured on real sensors.
constexpr std::uint64_t kDataPerPosition = 9;
constexpr Duration kPositionDelay = std::chrono::microseconds{250};

constexpr Ipv4Address kSensor = Ipv4Address::from_octets(192, 168, 1, 201);
constexpr Ipv4Address kBroadcast = Ipv4Address::from_octets(255, 255, 255, 255);

// What draws random numbers; each its own stream.
enum Stream : std::uint32_t {
  kLidarStream,
  kNetworkStream,
  kSerialImuStream,
  kReadsStream,
  kCanStream
};

MicrosPastHour counter(PpsState pps, Duration since_start) {
  const Duration counted = pps == PpsState::locked ? (kStart + since_start).time_since_epoch()
                                                   : kRunningFor + since_start;
  const auto micros = std::chrono::floor<std::chrono::microseconds>(counted % kHour);
  return {static_cast<std::uint32_t>(micros.count())};
}

capture::Record datagram(HostTime stamp, std::uint16_t port, std::span<const std::byte> payload) {
  return {.stamp = stamp,
          .kind = capture::RecordKind::datagram,
          .source_port = port,
          .destination_port = port,
          .source = kSensor,
          .destination = kBroadcast,
          .payload = payload};
}

Period imu_period(const RecordingOptions& options) {
  return {.from = -options.imu_margin, .length = options.length + 2 * options.imu_margin};
}

}  // namespace

void write_lidar(const RecordingOptions& options, const std::filesystem::path& pcap,
                 const Progress& progress) {
  LidarSimulator lidar(demo_room(options.furnishing), RigMotion(options.motion), options.lidar,
                       Random(options.seed, kLidarStream));
  Random network(options.seed, kNetworkStream);
  const auto jitter = [&] {
    return Duration{static_cast<Duration::rep>(network.uniform(0.0, kJitterNs))};
  };
  capture::CaptureWriter out(pcap, capture::LinkKind::ethernet);
  const auto packets = static_cast<std::uint64_t>(options.length / LidarSimulator::kPacketPeriod);
  DataPacket packet;
  for (std::uint64_t i = 0; i < packets; ++i) {
    const Duration first = LidarSimulator::first_firing(i);
    const Duration complete = first + LidarSimulator::kPacketPeriod;
    lidar.fill(i, packet.blocks);
    packet.first_firing = counter(options.pps, first);
    out.write(
        datagram(kStart + complete + kDataDelay + jitter(), layout::kDataPort, encode(packet)));
    if (i % kDataPerPosition == kDataPerPosition - 1) {
      const PositionPacketBytes position = encode(PositionPacket{
          .sent = counter(options.pps, complete), .utc = kStart + complete, .pps = options.pps});
      out.write(
          datagram(kStart + complete + kPositionDelay + jitter(), layout::kPositionPort, position));
    }
    if (progress) progress(i + 1, packets);
  }
  out.close();
}

void write_serial_imu(const RecordingOptions& options, const std::filesystem::path& pcap) {
  Random noise(options.seed, kSerialImuStream);
  Random reading(options.seed, kReadsStream);
  SerialLine line(options.serial_imu.baud);
  send_samples(options.serial_imu, RigMotion(options.motion), kStart, imu_period(options), noise,
               line);
  capture::CaptureWriter out(pcap, capture::LinkKind::serial);
  for (const SerialRead& read : line.reads(reading)) {
    out.write({.stamp = read.stamp, .kind = capture::RecordKind::serial, .payload = read.bytes});
  }
  out.close();
}

void write_can_imu(const RecordingOptions& options, const std::filesystem::path& log) {
  Random random(options.seed, kCanStream);
  replay::AtomicFile out(log);
  out.write(
      candump_log(options.can_imu, RigMotion(options.motion), kStart, imu_period(options), random));
  out.commit();
}

void write_recording(const RecordingOptions& options, const std::filesystem::path& folder,
                     const Progress& progress) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw std::runtime_error("cannot make the folder " + folder.string() + ": " + error.message());
  }
  write_serial_imu(options, folder / "imu.pcap");
  write_can_imu(options, folder / "can.log");
  write_lidar(options, folder / "lidar.pcap", progress);
}

}  // namespace convexcut::sim
