// SPDX-License-Identifier: Apache-2.0
//
// Identifiers, layouts and scales: MTi 600-series CAN protocol, MT1604P. All numbers big-endian.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "drivers/wire.hpp"
#include "replay/simulation/wire/imu_simulator.hpp"
#include "replay/text.hpp"

namespace convexcut::simulation {
namespace {

constexpr std::uint32_t kSampleTimeId = 0x005;    // u32, µs
constexpr std::uint32_t kGroupCounterId = 0x006;  // u16
constexpr std::uint32_t kQuaternionId = 0x021;    // 4 × i16 of 1/32767
constexpr std::uint32_t kRateOfTurnId = 0x032;    // 3 × i16 of 2⁻⁹ rad/s
constexpr std::uint32_t kAccelerationId = 0x034;  // 3 × i16 of 2⁻⁸ m/s²
constexpr double kQuaternionUnit = 1.0 / 32767.0;
constexpr double kRateOfTurnUnit = 0x1p-9;
constexpr double kAccelerationUnit = 0x1p-8;

constexpr std::uint32_t kFirstMicros = 123'456'789;  // the device has run for a while
constexpr std::uint16_t kFirstCount = 65'450;        // wraps soon
constexpr Duration kProcessing = std::chrono::microseconds{150};

class Bus {
 public:
  Bus(std::uint32_t bitrate, Random& random) : bitrate_(bitrate), random_(random) {}

  // A group of frames begins, when the bus is free.
  void wait_until(HostTime time) { free_at_ = std::max(free_at_, time); }

  void send(std::uint32_t id, std::span<const std::byte> data) {
    // 47 bits around the data with an 11-bit identifier, and about a tenth of stuffed bits.
    const double bits = 1.1 * static_cast<double>(47 + 8 * data.size());
    free_at_ += Duration{std::llround(bits * 1e9 / bitrate_)};
    append_line(free_at_ + Duration{static_cast<Duration::rep>(random_.uniform(5e3, 40e3))}, id,
                data);
  }

  void send_scaled(std::uint32_t id, double unit, std::span<const double> values) {
    std::array<std::byte, 8> data{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const long raw = std::clamp(std::lround(values[i] / unit), -32768L, 32767L);
      wire::store_be<std::int16_t>(data, 2 * i, static_cast<std::int16_t>(raw));
    }
    send(id, std::span(data).first(2 * values.size()));
  }

  [[nodiscard]] std::string take_log() { return std::move(log_); }

 private:
  void append_line(HostTime received, std::uint32_t id, std::span<const std::byte> data) {
    const std::int64_t micros = to_ns(received) / 1000;
    log_ +=
        replay::format("(%010lld.%06lld) can0 %03X#", static_cast<long long>(micros / 1'000'000),
                       static_cast<long long>(micros % 1'000'000), id);
    for (const std::byte b : data) log_ += replay::format("%02X", std::to_integer<unsigned>(b));
    log_ += '\n';
  }

  double bitrate_;
  Random& random_;
  HostTime free_at_{};
  std::string log_;
};

void send_scaled(Bus& bus, std::uint32_t id, double unit, const Vec3& truth, double noise,
                 Random& random) {
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = truth[static_cast<Eigen::Index>(i)] + noise * random.gaussian();
  }
  bus.send_scaled(id, unit, values);
}

}  // namespace

std::string candump_log(const CanImuOptions& options, RigStateAt motion, HostTime start,
                        const Period& period, Random& random) {
  Bus bus(options.bitrate, random);
  const Duration step = Duration{std::chrono::seconds{1}} / options.rate_hz;
  for (std::int64_t i = 0; step * i < period.length; ++i) {
    const Duration sampled = period.from + options.clock.true_time(step * i);
    const RigState rig = motion(sampled);
    bus.wait_until(start + sampled + kProcessing);

    std::array<std::byte, 4> time{};
    wire::store_be<std::uint32_t>(
        time, 0, static_cast<std::uint32_t>(kFirstMicros + (step * i).count() / 1000));
    bus.send(kSampleTimeId, time);
    std::array<std::byte, 2> count{};
    wire::store_be<std::uint16_t>(count, 0, static_cast<std::uint16_t>(kFirstCount + i));
    bus.send(kGroupCounterId, count);

    const Quaternion& q = rig.q_level_from_imu;
    bus.send_scaled(kQuaternionId, kQuaternionUnit, std::array{q.w(), q.x(), q.y(), q.z()});
    send_scaled(bus, kRateOfTurnId, kRateOfTurnUnit, rig.angular_velocity_rad_s,
                options.noise.rate_of_turn_rad_s, random);
    send_scaled(bus, kAccelerationId, kAccelerationUnit, rig.specific_force_m_s2,
                options.noise.acceleration_m_s2, random);
  }
  return bus.take_log();
}

}  // namespace convexcut::simulation
