// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/wire/lidar_link.hpp"

#include "drivers/ipv4_address.hpp"

namespace convexcut::simulation {
namespace {

// Without PPS the counter runs from power-on.
constexpr Duration kRunningFor = std::chrono::milliseconds{754'321};

// From the end of a packet to the host's stamp: the line (1248 bytes at 100 Mbit/s), then the host.
constexpr Duration kDataDelay = std::chrono::microseconds{105};
constexpr Duration kPositionDelay = std::chrono::microseconds{145};  // after the data packet
// From a datagram to one that overtakes it, or to its double.
constexpr Duration kBehind = std::chrono::microseconds{4};
// A position packet follows every ninth data packet: 201 a second, as measured on real sensors.
constexpr Duration kPositionPeriod{9 * 552'960};

constexpr Ipv4Address kSensor = Ipv4Address::from_octets(192, 168, 1, 201);
constexpr Ipv4Address kBroadcast = Ipv4Address::from_octets(255, 255, 255, 255);

}  // namespace

MicrosPastHour LidarLink::counter(Duration elapsed) const noexcept {
  const Duration zero = options_.pps == PpsState::locked ? kStart.time_since_epoch() : kRunningFor;
  const Duration counted = zero + options_.clock_offset + elapsed;
  const Duration past_hour = (counted % kHour + kHour) % kHour;
  const auto micros = std::chrono::floor<std::chrono::microseconds>(past_hour);
  return {static_cast<std::uint32_t>(micros.count())};
}

void LidarLink::send(DataPacket& packet, const Moment& moment, Emit emit) {
  Random random(seed_, stream_, packets_++);
  packet.first_firing = counter(moment.first_firing);
  const HostTime stamp = kStart + moment.complete + kDataDelay + jitter(random);
  if (!random.chance(options_.loss)) arrive(stamp, encode(packet), random, emit);
  if (moment.elapsed < next_position_ + kPositionPeriod) return;
  next_position_ += kPositionPeriod;
  send_position(moment, random, emit);
}

void LidarLink::arrive(HostTime stamp, const DataPacketBytes& bytes, Random& random, Emit emit) {
  newest_ = stamp;
  if (!overtaken_ && random.chance(options_.reorder)) {
    overtaken_ = bytes;
    return;
  }
  emit({stamp, layout::kDataPort, bytes});
  if (random.chance(options_.duplicate)) emit({stamp + kBehind, layout::kDataPort, bytes});
  if (overtaken_) emit({stamp + 2 * kBehind, layout::kDataPort, *overtaken_});
  overtaken_.reset();
}

void LidarLink::finish(Emit emit) {
  if (!overtaken_) return;
  emit({newest_ + kBehind, layout::kDataPort, *overtaken_});
  overtaken_.reset();
}

void LidarLink::send_position(const Moment& moment, Random& random, Emit emit) const {
  const PositionPacketBytes bytes = encode(PositionPacket{
      .sent = counter(moment.elapsed), .utc = kStart + moment.complete, .pps = options_.pps});
  emit({kStart + moment.complete + kDataDelay + options_.jitter + kPositionDelay + jitter(random),
        layout::kPositionPort, bytes});
}

Duration LidarLink::jitter(Random& random) const noexcept {
  return Duration{static_cast<Duration::rep>(
      random.uniform(0.0, static_cast<double>(options_.jitter.count())))};
}

void write(const Datagram& datagram, capture::CaptureWriter& out) {
  out.write({.stamp = datagram.stamp,
             .kind = capture::RecordKind::datagram,
             .source_port = datagram.port,
             .destination_port = datagram.port,
             .source = kSensor,
             .destination = kBroadcast,
             .payload = datagram.payload});
}

}  // namespace convexcut::simulation
