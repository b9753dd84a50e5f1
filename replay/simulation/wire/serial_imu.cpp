// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "replay/simulation/wire/imu_simulator.hpp"
#include "replay/simulation/wire/mtdata2_writer.hpp"

namespace convexcut::simulation {
namespace {

constexpr Duration kTick = std::chrono::microseconds{100};  // of SampleTimeFine
constexpr std::uint32_t kFirstTick = 4'562'336;             // the device has run for a while
constexpr std::uint16_t kFirstCount = 65'400;               // wraps after 1.36 s at 100 Hz
constexpr std::uint32_t kStatus = 0x0040'0003;              // self-test and filter fine, SyncOut
constexpr Duration kProcessing = std::chrono::microseconds{200};  // from sampling to sending

std::array<float, 3> noisy(const Vec3& truth, double noise, Random& random) {
  std::array<float, 3> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<float>(truth[static_cast<Eigen::Index>(i)] + noise * random.gaussian());
  }
  return values;
}

std::array<float, 4> wxyz(const Quaternion& q) {
  return {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()),
          static_cast<float>(q.z())};
}

}  // namespace

void send_samples(const SerialImuOptions& options, RigStateAt motion, HostTime start,
                  const Period& period, Random& random, SerialLine& line) {
  const Duration step = Duration{std::chrono::seconds{1}} / options.rate_hz;
  for (std::int64_t i = 0; step * i < period.length; ++i) {
    const Duration sampled = period.from + options.clock.true_time(step * i);
    const RigState rig = motion(sampled);
    MtData2Writer message;
    message.add(xsens::DataType::packet_counter, static_cast<std::uint16_t>(kFirstCount + i));
    message.add(xsens::DataType::sample_time_fine,
                static_cast<std::uint32_t>(kFirstTick + step * i / kTick));
    message.add(xsens::DataType::quaternion, wxyz(rig.q_level_from_imu));
    message.add(xsens::DataType::acceleration,
                noisy(rig.specific_force_m_s2, options.noise.acceleration_m_s2, random));
    message.add(xsens::DataType::rate_of_turn,
                noisy(rig.angular_velocity_rad_s, options.noise.rate_of_turn_rad_s, random));
    message.add(xsens::DataType::status_word, kStatus);
    const Duration late{static_cast<Duration::rep>(
        random.uniform(0.0, static_cast<double>(options.jitter.count())))};
    line.send(start + sampled + kProcessing + late, message.frame());
  }
}

}  // namespace convexcut::simulation
