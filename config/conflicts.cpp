// SPDX-License-Identifier: Apache-2.0
#include "config/conflicts.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "config/schema.hpp"
#include "config/value_text.hpp"

namespace convexcut::config {
namespace {

constexpr std::uint32_t kStandardCanIds = 0x7FF;
constexpr std::uint32_t kMaxImuRateHz = 400;  // of the MTi's orientation
constexpr std::uint32_t kBitsPerByte = 10;    // 8N1

class Conflicts {
 public:
  explicit Conflicts(const Config& config) : config_(config) {}

  void add(std::vector<std::string_view> keys, std::string text) {
    found_.push_back({std::move(keys), std::move(text)});
  }

  void require_less(std::string_view a, std::string_view b) {
    if (number(a) < number(b)) return;
    add({a, b}, concat("expected ", a, " < ", b, ", found ", shown(a), " and ", shown(b)));
  }

  // All pairs of the keys.
  template <std::size_t N>
  void require_different(const std::array<std::string_view, N>& keys) {
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = i + 1; j < N; ++j) {
        if (value(keys[i]) != value(keys[j])) continue;
        add({keys[i], keys[j]}, concat("expected ", keys[i], " and ", keys[j], " to differ, found ",
                                       shown(keys[i]), " for both"));
      }
    }
  }

  void require_standard_id(std::string_view key, std::string_view extended) {
    if (number(key) <= kStandardCanIds) return;
    add({key, extended},
        concat("expected at most 0x7ff without ", extended, ", found ", key, " = ", shown(key)));
  }

  // Where `key` = `value` of it asks for `wanted` of another key.
  void require_with(std::string_view key, std::string_view other, std::string_view wanted) {
    if (std::get<std::string>(value(other)) == wanted) return;
    add({key, other}, concat("expected ", other, " = \"", wanted, "\" with ", key, " = ",
                             shown(key), ", found ", shown(other)));
  }

  [[nodiscard]] std::vector<Conflict> take() { return std::move(found_); }

 private:
  [[nodiscard]] Value value(std::string_view key) const { return find_key(key)->get(config_); }
  [[nodiscard]] double number(std::string_view key) const {
    const Value v = value(key);
    const auto* integer = std::get_if<std::int64_t>(&v);
    return integer != nullptr ? static_cast<double>(*integer) : std::get<double>(v);
  }
  [[nodiscard]] std::string shown(std::string_view key) const {
    return to_toml(value(key), find_key(key)->domain);
  }

  const Config& config_;
  std::vector<Conflict> found_;
};

std::optional<std::string> user_of_port(std::uint32_t domain, std::uint16_t port) {
  constexpr std::uint32_t kBase = 7400;
  constexpr std::uint32_t kDomainGain = 250;
  constexpr std::uint32_t kFirstParticipant = 10;
  constexpr std::uint32_t kPortsPerParticipant = 2;
  constexpr std::uint32_t kLastParticipant = 32;
  const std::uint32_t first = kBase + kDomainGain * domain;
  if (port < first) return std::nullopt;
  const std::uint32_t offset = port - first;
  const std::string of_domain =
      "port " + std::to_string(port) + " is used by DDS domain " + std::to_string(domain);
  if (offset <= 1) return of_domain + " for multicast";
  if (offset < kFirstParticipant) return std::nullopt;
  const std::uint32_t participant = (offset - kFirstParticipant) / kPortsPerParticipant;
  if (participant > kLastParticipant) return std::nullopt;
  return of_domain + " for its participant " + std::to_string(participant);
}

}  // namespace

std::optional<std::string> port_collision(std::uint32_t domain, std::uint16_t data_port,
                                          std::uint16_t position_port) {
  std::optional<std::string> user = user_of_port(domain, data_port);
  return user ? user : user_of_port(domain, position_port);
}

namespace {

void check_imu_configuration(const Imu& imu, Conflicts& conflicts) {
  if (kMaxImuRateHz % imu.rate_hz != 0) {
    conflicts.add({"imu.rate_hz"}, "expected a divisor of " + std::to_string(kMaxImuRateHz) +
                                       ", found " + std::to_string(imu.rate_hz));
  }
  const bool changed = imu.baud != 0 && imu.set_baud != 0;  // USB has no rate to change
  const std::uint32_t line = changed ? imu.set_baud : imu.baud;
  const std::uint32_t needed = imu.rate_hz * kConfiguredMessageBytes * kBitsPerByte;
  if (imu.configure && line != 0 && needed > line) {
    conflicts.add({"imu.configure", "imu.rate_hz", "imu.baud", "imu.set_baud"},
                  "expected a line of at least " + std::to_string(needed) + " bit/s for " +
                      std::to_string(imu.rate_hz) + " Hz, found " + std::to_string(line) +
                      ": set imu.set_baud, or a lower imu.rate_hz");
  }
}

// From the start bit to the end of the longest frame.
std::uint32_t bits_behind(const Encoder& encoder) {
  constexpr std::uint32_t kFrameBits = 64 * 8;
  const std::uint32_t start = encoder.start_bit;
  if (encoder.byte_order == ByteOrder::intel) return kFrameBits - start;
  return kFrameBits - start / 8 * 8 - (7 - start % 8);
}

void check_encoder(const Config& config, std::span<const std::string_view> can_ids,
                   Conflicts& conflicts) {
  const Encoder& encoder = config.encoder;
  conflicts.require_with("encoder.use", "mount.orientation",
                         encoder.use == EncoderUse::yaw ? "imu" : "fixed");
  if (encoder.use == EncoderUse::yaw) {
    conflicts.require_with("encoder.use", "encoder.axis", "rotation");
  }
  if (!encoder.extended_id) conflicts.require_standard_id("encoder.id", "encoder.extended_id");
  if (encoder.extended_id == config.can.extended_ids) {
    for (const std::string_view id : can_ids) {
      conflicts.require_different(std::array<std::string_view, 2>{"encoder.id", id});
    }
  }
  if (encoder.scale_deg == 0.0) {
    conflicts.add({"encoder.scale_deg"}, "expected another number than 0, found 0");
  }
  if (encoder.preset == EncoderPreset::none && encoder.length_bits > bits_behind(encoder)) {
    conflicts.add({"encoder.start_bit", "encoder.length_bits", "encoder.byte_order"},
                  "expected a count that ends within 64 bytes, found " +
                      std::to_string(encoder.length_bits) + " bits from bit " +
                      std::to_string(encoder.start_bit));
  }
}

}  // namespace

std::vector<Conflict> find_conflicts(const Config& config) {
  constexpr std::array<std::string_view, 7> kCanIds{
      "can.sample_time_id", "can.group_counter_id", "can.status_id",      "can.quaternion_id",
      "can.euler_id",       "can.rate_of_turn_id",  "can.acceleration_id"};
  Conflicts conflicts(config);
  conflicts.require_less("lidar.min_range_m", "lidar.max_range_m");
  conflicts.require_less("worker.latency_ms", "worker.period_ms");
  conflicts.require_less("realtime.publish_priority", "realtime.worker_priority");
  conflicts.require_less("realtime.worker_priority", "realtime.receive_priority");
  conflicts.require_different(
      std::array<std::string_view, 2>{"lidar.data_port", "lidar.position_port"});
  conflicts.require_different(kCanIds);
  if (!config.can.extended_ids) {
    for (const std::string_view id : kCanIds) {
      conflicts.require_standard_id(id, "can.extended_ids");
    }
  }
  conflicts.require_different(
      std::array<std::string_view, 3>{"dds.structure_topic", "dds.points_topic", "dds.imu_topic"});
  conflicts.require_different(std::array<std::string_view, 2>{"dds.level_frame", "dds.imu_frame"});
  check_imu_configuration(config.imu, conflicts);
  if (config.encoder.use != EncoderUse::off) check_encoder(config, kCanIds, conflicts);
  const auto collision =
      port_collision(config.dds.domain, config.lidar.data_port, config.lidar.position_port);
  if (collision) {
    conflicts.add({"dds.domain", "lidar.data_port", "lidar.position_port"},
                  "expected ports of the lidar that DDS does not use, but " + *collision);
  }
  return conflicts.take();
}

}  // namespace convexcut::config
