// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/wire/hdl32e_packets.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>

#include "drivers/velodyne/model.hpp"
#include "drivers/wire.hpp"
#include "replay/text.hpp"

namespace convexcut::simulation {
namespace {

// The motion words carry what they are in bits 15…12 and a 12-bit two's complement value.
enum class MotionTag : std::uint16_t { gyro = 0, temperature = 1, accel_x = 2, accel_y = 3 };
constexpr std::uint16_t kOneG = 819;  // of 0.001221 g each

std::uint16_t motion_word(MotionTag tag, std::uint16_t value) {
  return static_cast<std::uint16_t>((static_cast<unsigned>(tag) << 12U) | (value & 0x0FFFU));
}

// "$GPRMC,hhmmss,A,…*hh\r\n"
std::string gprmc(HostTime utc, bool valid) {
  namespace chr = std::chrono;
  const chr::sys_time<Duration> time(utc.time_since_epoch());
  const auto day = chr::floor<chr::days>(time);
  const chr::year_month_day date(day);
  const chr::hh_mm_ss clock(chr::floor<chr::seconds>(time - day));
  std::string sentence = replay::format(
      "$GPRMC,%02d%02d%02d,%c,5231.2000,N,01324.3000,E,000.0,000.0,%02u%02u%02d,,,%c",
      static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
      static_cast<int>(clock.seconds().count()), valid ? 'A' : 'V',
      static_cast<unsigned>(date.day()), static_cast<unsigned>(date.month()),
      static_cast<int>(date.year()) % 100, valid ? 'A' : 'N');
  unsigned checksum = 0;  // NMEA 0183: all characters between $ and *
  for (const char c : std::string_view(sentence).substr(1)) {
    checksum ^= static_cast<unsigned char>(c);
  }
  sentence += replay::format("*%02X\r\n", checksum);
  return sentence;
}

}  // namespace

DataPacketBytes encode(const DataPacket& packet) {
  DataPacketBytes bytes{};
  const wire::WritableBytes all(bytes);
  for (std::size_t b = 0; b < layout::kBlocks; ++b) {
    const DataBlock& block = packet.blocks[b];
    const wire::WritableBytes out = all.subspan(b * layout::kBlockSize, layout::kBlockSize);
    wire::store_le<std::uint16_t>(out, layout::kBlockFlag, layout::kUpperBankFlag);
    constexpr std::int32_t kUnit = Azimuth::kPerCentidegree;
    const std::int32_t centidegrees = (block.azimuth.microdegrees() + kUnit / 2) / kUnit;
    wire::store_le<std::uint16_t>(out, layout::kBlockAzimuth,
                                  static_cast<std::uint16_t>(centidegrees));
    for (std::size_t i = 0; i < layout::kReturnsPerBlock; ++i) {
      const std::size_t at = layout::kBlockReturns + i * layout::kReturnSize;
      wire::store_le<std::uint16_t>(out, at + layout::kReturnDistance,
                                    block.returns[i].distance_2mm);
      wire::store_le<std::uint8_t>(out, at + layout::kReturnIntensity, block.returns[i].intensity);
    }
  }
  wire::store_le<std::uint32_t>(all, layout::kDataTimestamp, packet.first_firing.count);
  wire::store_le<std::uint8_t>(all, layout::kReturnMode,
                               packet.dual ? layout::kModeDual : layout::kModeStrongest);
  wire::store_le<std::uint8_t>(all, layout::kProduct,
                               velodyne::model_of(velodyne::ModelId::hdl32e).product);
  return bytes;
}

PositionPacketBytes encode(const PositionPacket& packet) {
  PositionPacketBytes bytes{};
  const wire::WritableBytes all(bytes);
  for (std::size_t set = 0; set < layout::kMotionSets; ++set) {
    const wire::WritableBytes out =
        all.subspan(layout::kMotion + set * layout::kMotionSetSize, layout::kMotionSetSize);
    // Two of the three sensors stand upright: their x is vertical.
    const std::uint16_t gravity = set < 2 ? kOneG : 0;
    wire::store_le<std::uint16_t>(out, layout::kMotionGyro, motion_word(MotionTag::gyro, 0));
    wire::store_le<std::uint16_t>(out, layout::kMotionTemperature,
                                  motion_word(MotionTag::temperature, 0));
    wire::store_le<std::uint16_t>(out, layout::kMotionAccelX,
                                  motion_word(MotionTag::accel_x, gravity));
    wire::store_le<std::uint16_t>(out, layout::kMotionAccelY, motion_word(MotionTag::accel_y, 0));
  }
  wire::store_le<std::uint32_t>(all, layout::kPositionTimestamp, packet.sent.count);
  wire::store_le<std::uint8_t>(all, layout::kPpsState, static_cast<std::uint8_t>(packet.pps));
  const std::string sentence = gprmc(packet.utc, packet.pps == PpsState::locked);
  std::ranges::transform(sentence, all.subspan(layout::kNmea).begin(),
                         [](char c) { return static_cast<std::byte>(c); });
  return bytes;
}

}  // namespace convexcut::simulation
