// SPDX-License-Identifier: Apache-2.0
//
// The same motion sent over serial and over CAN. Does not prove that two real devices would agree:
// both encodings are made here.
#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "drivers/can/can_imu_driver.hpp"
#include "drivers/xsens/imu_driver.hpp"
#include "tests/drivers/can/frames.hpp"
#include "tests/drivers/xsens/frames.hpp"
#include "tests/drivers/xsens/recording_sink.hpp"

namespace convexcut::can {
namespace {

using convexcut::test::RecordingSink;
using test::make_frame;

constexpr HostTime kFirstSample = from_ns<HostTime>(1'700'000'000'000'000'000);

class BothLines : public testing::Test {
 protected:
  struct Motion {
    std::uint32_t time_100us;
    std::uint16_t count;
    Quaternion q;
    Vec3 rate;
    Vec3 acceleration;
  };

  static std::int16_t rounded(double value, double scale) {
    return static_cast<std::int16_t>(std::lround(value / scale));
  }
  static void put(xsens::test::ByteVector& to, std::uint64_t value, unsigned bytes) {
    for (unsigned i = bytes; i-- > 0;) to.push_back(static_cast<std::byte>(value >> (8 * i)));
  }
  static void put_f64(xsens::test::ByteVector& to, double value) {
    put(to, std::bit_cast<std::uint64_t>(value), 8);
  }

  void send_serial(const Motion& m) {
    xsens::test::ByteVector payload;
    put(payload, 0x102002, 3);
    put(payload, m.count, 2);
    put(payload, 0x106004, 3);
    put(payload, m.time_100us, 4);
    put(payload, 0x201320, 3);
    for (const double v : {m.q.w(), m.q.x(), m.q.y(), m.q.z()}) put_f64(payload, v);
    put(payload, 0x802318, 3);
    for (const double v : m.rate) put_f64(payload, v);
    put(payload, 0x402318, 3);
    for (const double v : m.acceleration) put_f64(payload, v);
    put(payload, 0xE02004, 3);
    put(payload, 0x00400003, 4);
    serial_driver_.on_bytes(xsens::test::make_frame(0x36, payload), kFirstSample);
  }

  void send_frame(std::uint32_t id, const xsens::test::ByteVector& data) {
    CanFrame frame = make_frame(id, "", kFirstSample + std::chrono::microseconds{500 * sent_++});
    std::copy(data.begin(), data.end(), frame.data.begin());
    frame.length = static_cast<std::uint8_t>(data.size());
    can_driver_.on_frame(frame);
  }
  void send_vector(std::uint32_t id, const Vec3& v, double scale) {
    xsens::test::ByteVector data;
    for (const double x : v) put(data, static_cast<std::uint16_t>(rounded(x, scale)), 2);
    send_frame(id, data);
  }
  void send_can(const Motion& m) {
    xsens::test::ByteVector data;
    put(data, m.time_100us * 100ULL, 4);
    send_frame(0x005, data);
    data.clear();
    put(data, m.count, 2);
    send_frame(0x006, data);
    send_frame(0x011, convexcut::test::hex("00400003"));
    data.clear();
    for (const double v : {m.q.w(), m.q.x(), m.q.y(), m.q.z()}) {
      put(data, static_cast<std::uint16_t>(rounded(v, 1 / 32767.0)), 2);
    }
    send_frame(0x021, data);
    send_vector(0x032, m.rate, 0x1p-9);
    send_vector(0x034, m.acceleration, 0x1p-8);
  }

  RecordingSink serial_;
  RecordingSink can_;
  xsens::ImuDriver serial_driver_{{}, serial_};
  CanImuDriver can_driver_{{}, can_};
  int sent_ = 0;
};

TEST_F(BothLines, GiveTheSameSamplesWithinTheResolutionOfCan) {
  std::mt19937 random(42);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (std::uint16_t n = 0; n < 200; ++n) {
    Motion m;
    m.count = static_cast<std::uint16_t>(65500 + n);
    m.time_100us = 500'000U + 100U * n;
    m.q = Quaternion(unit(random), unit(random), unit(random), unit(random)).normalized();
    m.rate = 30 * Vec3(unit(random), unit(random), unit(random));
    m.acceleration = 90 * Vec3(unit(random), unit(random), unit(random));
    send_serial(m);
    send_can(m);
  }
  can_driver_.flush();
  ASSERT_EQ(serial_.samples.size(), 200U);
  ASSERT_EQ(can_.samples.size(), 200U);
  for (std::size_t i = 0; i < 200; ++i) {
    const ImuSample& a = serial_.samples[i];
    const ImuSample& b = can_.samples[i];
    EXPECT_EQ(a.device_time, b.device_time);
    EXPECT_EQ(a.counter, b.counter);
    EXPECT_EQ(a.status, b.status);
    EXPECT_TRUE(b.has_orientation && b.has_angular_velocity && b.has_acceleration);
    EXPECT_LT(a.q_level_from_imu.angularDistance(b.q_level_from_imu), 2 * 2 * 0.5 / 32767);
    EXPECT_LE((a.angular_velocity_rad_s - b.angular_velocity_rad_s).cwiseAbs().maxCoeff(),
              0x1p-10F * 1.001F);
    EXPECT_LE((a.acceleration_m_s2 - b.acceleration_m_s2).cwiseAbs().maxCoeff(), 0x1p-9F * 1.001F);
  }
}

}  // namespace
}  // namespace convexcut::can
