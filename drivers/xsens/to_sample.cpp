// SPDX-License-Identifier: Apache-2.0
#include "drivers/xsens/to_sample.hpp"

#include <optional>

#include "drivers/xsens/orientation.hpp"

namespace convexcut::xsens {
namespace {

const Reals<3>* one_of(const MtMeasurement& m, MtItem first, const Reals<3>& first_value,
                       MtItem second, const Reals<3>& second_value) noexcept {
  if (m.has(first)) return &first_value;
  return m.has(second) ? &second_value : nullptr;
}

const Reals<3>* rate_of_turn(const MtMeasurement& m) noexcept {
  return one_of(m, MtItem::rate_of_turn, m.rate_of_turn_rad_s, MtItem::rate_of_turn_hr,
                m.rate_of_turn_hr_rad_s);
}

const Reals<3>* acceleration(const MtMeasurement& m) noexcept {
  return one_of(m, MtItem::acceleration, m.acceleration_m_s2, MtItem::acceleration_hr,
                m.acceleration_hr_m_s2);
}

// Whether `value` is there and finite, also as float.
bool fill_vector(const Reals<3>* value, Vec3f& out, Counter& invalid) noexcept {
  if (value == nullptr) return false;
  const Vec3f vector = Vec3(value->data()).cast<float>();
  if (!vector.allFinite()) {
    invalid.add();
    return false;
  }
  out = vector;
  return true;
}

}  // namespace

bool makes_sample(const MtMeasurement& m) noexcept {
  return has_orientation(m) || rate_of_turn(m) != nullptr || acceleration(m) != nullptr;
}

void fill_sample(const MtMeasurement& m, ImuSample& sample, ValueCounters& counters) noexcept {
  sample = ImuSample{};
  if (has_orientation(m)) {
    if (const std::optional<Quaternion> q = q_level_from_imu(m)) {
      sample.q_level_from_imu = *q;
      sample.has_orientation = true;
    } else {
      counters.invalid_orientations.add();
    }
  }
  sample.has_angular_velocity =
      fill_vector(rate_of_turn(m), sample.angular_velocity_rad_s, counters.invalid_vectors);
  sample.has_acceleration =
      fill_vector(acceleration(m), sample.acceleration_m_s2, counters.invalid_vectors);
  sample.has_status = m.has(MtItem::status_word) || m.has(MtItem::status_byte);
  sample.status = m.has(MtItem::status_word) ? m.status_word : m.status_byte;
  sample.has_counter = m.has(MtItem::packet_counter);
  sample.counter = m.packet_counter;
}

}  // namespace convexcut::xsens
