// SPDX-License-Identifier: Apache-2.0
//
// Layouts and scales of the Xsens CAN messages. Does not prove them on hardware: where the public
// sources contradict each other, docs/design/imu.md says which one is followed.
#include "drivers/can/xsens_can.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/drivers/can/frames.hpp"

namespace convexcut::can {
namespace {

using test::make_frame;
using xsens::MtItem;
using xsens::Reals;

XsensCanData decode(std::uint32_t id, std::string_view data_hex) {
  const CanFrame frame = make_frame(id, data_hex);
  XsensCanData data;
  const auto message = XsensCanIds{}.find(frame);
  EXPECT_TRUE(message) << std::hex << id;
  if (message) {
    EXPECT_TRUE(decode_xsens(*message, frame, data)) << std::hex << id;
  }
  return data;
}

template <std::size_t N>
void expect_near(const Reals<N>& actual, const Reals<N>& expected, double tolerance = 0) {
  for (std::size_t i = 0; i < N; ++i) EXPECT_NEAR(actual[i], expected[i], tolerance) << i;
}

TEST(XsensCan, Acceleration) {
  const auto m = decode(0x034, "00 00 00 00 09 CF").measurement;
  expect_near(m.acceleration_m_s2, {0, 0, 2511 / 256.0});
  EXPECT_TRUE(m.has(MtItem::acceleration));
}

TEST(XsensCan, RateOfTurn) {
  expect_near(decode(0x032, "00 64 FF 9C 00 00").measurement.rate_of_turn_rad_s,
              {0.1953125, -0.1953125, 0});
}

TEST(XsensCan, QuaternionOf32767IsOne) {
  expect_near(decode(0x021, "7F FF 00 00 00 00 00 00").measurement.quaternion.value, {1, 0, 0, 0});
  expect_near(decode(0x021, "00 00 80 01 00 00 00 00").measurement.quaternion.value, {0, -1, 0, 0});
}

TEST(XsensCan, DeltaVIsScaledByTheExponentInTheFrame) {
  expect_near(decode(0x031, "01 00 FF 00 00 00 11").measurement.delta_v_m_s,
              {0.001953125, -0.001953125, 0});
  expect_near(decode(0x031, "01 00 FF 00 00 00 08").measurement.delta_v_m_s, {1, -1, 0});
}

TEST(XsensCan, TemperatureIsSigned) {
  EXPECT_EQ(decode(0x051, "FF 00").measurement.temperature_c[0], -1.0);
  EXPECT_EQ(decode(0x051, "19 80").measurement.temperature_c[0], 25.5);
}

TEST(XsensCan, BaroPressureIsUnsigned) {
  EXPECT_EQ(decode(0x052, "C5 E6 80 00").measurement.baro_pressure_pa, 101325.0);
}

TEST(XsensCan, SampleTimeAndGroupCounter) {
  EXPECT_EQ(decode(0x005, "FF FF FF FE").sample_time_us, 0xFFFFFFFEU);
  const auto m = decode(0x006, "FF FE").measurement;
  EXPECT_EQ(m.packet_counter, 65534);
  EXPECT_TRUE(m.has(MtItem::packet_counter));
}

TEST(XsensCan, UtcTimeWithTwoDigitsOfTheYear) {
  const auto utc = decode(0x007, "1A 0B 16 0D 2F 18 26 AD").measurement.utc;
  EXPECT_EQ(utc.year, 2026);
  EXPECT_EQ(utc.month, 11);
  EXPECT_EQ(utc.day, 22);
  EXPECT_EQ(utc.hour, 13);
  EXPECT_EQ(utc.minute, 47);
  EXPECT_EQ(utc.second, 24);
  EXPECT_EQ(utc.nanosecond, 990'100'000U);
  EXPECT_EQ(decode(0x007, "45 01 01 00 00 00 00 00").measurement.utc.year, 2069);
  EXPECT_EQ(decode(0x007, "46 01 01 00 00 00 00 00").measurement.utc.year, 1970);
}

TEST(XsensCan, StatusWordErrorAndWarning) {
  EXPECT_EQ(decode(0x011, "00 40 00 03").measurement.status_word, 0x00400003U);
  EXPECT_EQ(decode(0x001, "01").error, 1);
  EXPECT_EQ(decode(0x002, "07").warning, 7);
}

TEST(XsensCan, OtherVectors) {
  expect_near(decode(0x022, "2D 00 D3 00 00 01").measurement.euler_deg.value, {90, -90, 0x1p-7});
  expect_near(decode(0x033, "7F FF 80 01 00 00 00 00").measurement.delta_q, {1, -1, 0, 0});
  expect_near(decode(0x035, "01 00 FF 00 00 80").measurement.free_acceleration_m_s2, {1, -1, .5});
  expect_near(decode(0x041, "04 00 FC 00 02 00").measurement.magnetic_field, {1, -1, .5});
  expect_near(decode(0x076, "00 40 FF C0 00 20").measurement.velocity_m_s.value, {1, -1, .5});
}

TEST(XsensCan, HighRateIdsAreThoseOfTheSdk) {
  const auto gyro = decode(0x061, "02 00 FE 00 01 00").measurement;
  EXPECT_TRUE(gyro.has(MtItem::rate_of_turn_hr));
  expect_near(gyro.rate_of_turn_hr_rad_s, {1, -1, .5});
  const auto accelerometer = decode(0x062, "01 00 FF 00 00 80").measurement;
  EXPECT_TRUE(accelerometer.has(MtItem::acceleration_hr));
  expect_near(accelerometer.acceleration_hr_m_s2, {1, -1, .5});
}

TEST(XsensCan, Position) {
  // Latitude and longitude have different scales.
  expect_near(decode(0x071, "3C 00 00 00 F4 00 00 00").measurement.lat_lon_deg, {60, -24});
  EXPECT_EQ(decode(0x072, "FF FF 80 00").measurement.altitude_ellipsoid_m[0], -1.0);
}

TEST(XsensCan, EcefPositionIsThereWithItsThirdAxis) {
  XsensCanData data;
  ASSERT_TRUE(decode_xsens(XsensMessage::position_ecef_x, make_frame(0x73, "00000100"), data));
  ASSERT_TRUE(decode_xsens(XsensMessage::position_ecef_y, make_frame(0x74, "FFFFFF00"), data));
  EXPECT_FALSE(data.measurement.has(MtItem::position_ecef));
  ASSERT_TRUE(decode_xsens(XsensMessage::position_ecef_z, make_frame(0x75, "00000080"), data));
  EXPECT_TRUE(data.measurement.has(MtItem::position_ecef));
  expect_near(data.measurement.position_ecef_m, {1, -1, .5});
}

TEST(XsensCan, GnssReceiver) {
  const auto status = decode(0x079, "03 0B 01 37 0C").gnss_status;
  EXPECT_EQ(status.fix_type, 3);
  EXPECT_EQ(status.satellites_used, 11);
  EXPECT_EQ(status.flags, 1);
  EXPECT_EQ(status.valid, 0x37);
  EXPECT_EQ(status.satellites, 12);
  const auto dop = decode(0x07A, "00 96 00 64 FF FF 00 32").gnss_dop;
  EXPECT_DOUBLE_EQ(dop.position, 1.5);
  EXPECT_DOUBLE_EQ(dop.time, 1.0);
  EXPECT_DOUBLE_EQ(dop.vertical, 655.35);
  EXPECT_DOUBLE_EQ(dop.horizontal, 0.5);
}

TEST(XsensCan, EveryMessageIsDecodedFromItsLengthOnAndNotBelow) {
  const XsensCanIds ids;
  for (std::size_t i = 0; i < kXsensMessageCount; ++i) {
    const auto message = static_cast<XsensMessage>(i);
    for (std::uint8_t length = 0; length <= 8; ++length) {
      CanFrame frame = make_frame(ids.ids[i], "1122334455667788");
      frame.length = length;
      XsensCanData data;
      const bool decoded = decode_xsens(message, frame, data);
      EXPECT_EQ(decoded, length >= expected_length(message)) << i << ' ' << +length;
      EXPECT_EQ(data.has(message), decoded);
      if (!decoded) {
        EXPECT_EQ(data.measurement.items, 0U);
      }
    }
  }
}

TEST(XsensCanIds, DefaultsAreDistinctAndFoundInOrder) {
  const XsensCanIds ids;
  auto sorted = ids.ids;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end());
  EXPECT_EQ(ids.find(make_frame(0x021, "")), XsensMessage::quaternion);
  EXPECT_EQ(ids.find(make_frame(0x07A, "")), XsensMessage::gnss_receiver_dop);
  EXPECT_FALSE(ids.find(make_frame(0x020, "")));
}

TEST(XsensCanIds, AreConfigurable) {
  XsensCanIds ids;
  ids.extended = true;
  ids[XsensMessage::quaternion] = 0x19FF0032;
  CanFrame frame = make_frame(0x19FF0032, "");
  frame.extended = true;
  EXPECT_EQ(ids.find(frame), XsensMessage::quaternion);
  frame.extended = false;
  EXPECT_FALSE(ids.find(frame));
}

TEST(XsensCanIds, OnlyClassicDataFramesOfTheRightIdLengthAreFound) {
  const XsensCanIds ids;
  CanFrame frame = make_frame(0x021, "7FFF000000000000");
  ASSERT_TRUE(ids.find(frame));
  for (bool CanFrame::*flag :
       {&CanFrame::remote, &CanFrame::error, &CanFrame::fd, &CanFrame::extended}) {
    CanFrame other = frame;
    other.*flag = true;
    EXPECT_FALSE(ids.find(other));
  }
}

}  // namespace
}  // namespace convexcut::can
