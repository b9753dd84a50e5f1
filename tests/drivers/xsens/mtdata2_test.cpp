// SPDX-License-Identifier: Apache-2.0
//
// Payload parsing against documented and recorded messages. Does not prove the layout of items that
// no public recording holds (altitude over MSL, ECEF position, SampleTime64, PacketCounter32).
#include "drivers/xsens/mtdata2.hpp"

#include <set>

#include <gtest/gtest.h>

#include "tests/drivers/xsens/frames.hpp"

namespace convexcut::xsens {
namespace {

using test::ByteVector;
using test::hex;
using test::payload_of;

MtMeasurement parse(std::string_view frame_hex) {
  MtMeasurement m;
  EXPECT_EQ(parse_mtdata2(payload_of(hex(frame_hex)), m), PayloadStatus::ok);
  return m;
}

MtMeasurement parse_payload(std::string_view payload_hex) {
  MtMeasurement m;
  EXPECT_EQ(parse_mtdata2(hex(payload_hex), m), PayloadStatus::ok);
  return m;
}

template <std::size_t N>
void expect_near(const Reals<N>& actual, const Reals<N>& expected, double tolerance) {
  for (std::size_t i = 0; i < N; ++i) EXPECT_NEAR(actual[i], expected[i], tolerance) << i;
}

TEST(MtData2, OfficialExample) {
  const MtMeasurement m = parse(test::kOfficialExample);
  EXPECT_EQ(m.packet_counter, 57285);
  EXPECT_EQ(m.sample_time_fine, 4562336U);
  EXPECT_EQ(m.status_word, 0x81U);
  EXPECT_TRUE(m.has(MtItem::acceleration));
  EXPECT_TRUE(m.has(MtItem::rate_of_turn));
  EXPECT_FALSE(m.has(MtItem::quaternion));
}

TEST(MtData2, QuaternionOfARealDevice) {
  const MtMeasurement m = parse(test::kQuaternionMessage);
  EXPECT_EQ(m.packet_counter, 18050);
  EXPECT_EQ(m.sample_time_fine, 29686846U);
  EXPECT_EQ(m.status_word, 0x00400003U);
  expect_near(m.quaternion.value, {0.944556, -0.323088, 0.013747, -0.056913}, 5e-7);
  EXPECT_EQ(m.quaternion.frame, CoordinateSystem::enu);
}

TEST(MtData2, FullImuSetOfARealDevice) {
  const MtMeasurement m = parse(test::kImuSetMessage);
  EXPECT_EQ(m.packet_counter, 36240);
  EXPECT_EQ(m.sample_time_fine, 5561329U);
  expect_near(m.quaternion.value, {.99818522, -.00885724, .00490748, -.05936189}, 5e-9);
  expect_near(m.acceleration_m_s2, {-.10789835, -.18410529, 9.81525326}, 5e-9);
  expect_near(m.rate_of_turn_rad_s, {-.00086874, -.00810772, -.00362992}, 5e-9);
  for (const MtItem item : {MtItem::delta_v, MtItem::free_acceleration, MtItem::delta_q}) {
    EXPECT_TRUE(m.has(item));
  }
}

TEST(MtData2, Float32WithUtcAndEuler) {
  const MtMeasurement m = parse(test::kFloat32Message);
  EXPECT_EQ(m.packet_counter, 43399);
  EXPECT_EQ(m.sample_time_fine, 51703223U);
  EXPECT_EQ(m.utc.year, 2019);
  EXPECT_EQ(m.utc.month, 1);
  EXPECT_EQ(m.utc.day, 20);
  EXPECT_EQ(m.utc.hour, 13);
  EXPECT_EQ(m.utc.minute, 47);
  EXPECT_EQ(m.utc.second, 24);
  EXPECT_EQ(m.utc.nanosecond, 131'900'000U);
  EXPECT_EQ(m.utc.flags, 0x37);
  EXPECT_EQ(m.status_word, 5U);
  expect_near(m.euler_deg.value, {-99.461823, 0.133054, -179.190598}, 5e-7);
  expect_near(m.acceleration_m_s2, {.02831, -9.659713, -1.627351}, 5e-7);
}

TEST(MtData2, FixedPoint1220) {
  const MtMeasurement m = parse(test::kFp1220Message);
  expect_near(m.euler_deg.value, {-99.764153, -0.239947, 178.621353}, 5e-7);
  expect_near(m.acceleration_m_s2, {.045753, -9.687027, -1.628289}, 5e-7);
  EXPECT_TRUE(m.has(MtItem::status_byte));
  EXPECT_EQ(m.status_byte, 5);
}

TEST(MtData2, FixedPoint1632SendsTheFractionFirst) {
  const MtMeasurement m = parse(test::kFp1632Message);
  expect_near(m.euler_deg.value, {-99.520187, -0.357785, 177.873642}, 5e-7);
  expect_near(m.acceleration_m_s2, {.027548, -9.677625, -1.649223}, 5e-7);
}

TEST(MtData2, Float64) {
  const MtMeasurement m = parse(test::kFloat64Message);
  expect_near(m.euler_deg.value, {-99.496803, -0.033391, 179.805862}, 5e-7);
  expect_near(m.acceleration_m_s2, {.025932, -9.682502, -1.650182}, 5e-7);
}

TEST(MtData2, MessageWithoutInertialData) {
  const MtMeasurement m = parse(test::kNoInertialMessage);
  EXPECT_EQ(m.sample_time_fine, 51747718U);
  EXPECT_EQ(m.sample_time_coarse, 5174U);
  EXPECT_EQ(m.temperature_c[0], 36.8125);
  expect_near(m.magnetic_field, {.065342, .1918, .151003}, 5e-7);
  EXPECT_EQ(m.baro_pressure_pa, 101392.0);
  EXPECT_EQ(m.status_word, 0x01800005U);
}

TEST(MtData2, NumbersOfEveryFormatAtTheirLimits) {
  EXPECT_EQ(load_real(hex("3F800000"), 0, NumberFormat::float32), 1.0);
  EXPECT_EQ(load_real(hex("80000000"), 0, NumberFormat::fp12_20), -2048.0);
  EXPECT_EQ(load_real(hex("00000001"), 0, NumberFormat::fp12_20), 0x1p-20);
  EXPECT_EQ(load_real(hex("00000000 8000"), 0, NumberFormat::fp16_32), -32768.0);
  EXPECT_EQ(load_real(hex("FFFFFFFF FFFF"), 0, NumberFormat::fp16_32), -0x1p-32);
  EXPECT_EQ(load_real(hex("80000000 7FFF"), 0, NumberFormat::fp16_32), 32767.5);
  EXPECT_EQ(load_real(hex("C000000000000000"), 0, NumberFormat::float64), -2.0);
}

TEST(MtData2, CoordinateSystemComesWithTheItem) {
  const std::string identity = "10 3F800000 00000000 00000000 00000000";
  EXPECT_EQ(parse_payload("2010" + identity).quaternion.frame, CoordinateSystem::enu);
  EXPECT_EQ(parse_payload("2014" + identity).quaternion.frame, CoordinateSystem::ned);
  EXPECT_EQ(parse_payload("2018" + identity).quaternion.frame, CoordinateSystem::nwu);
}

TEST(MtData2, ReservedCoordinateSystemIsAnUnknownItem) {
  EXPECT_EQ(parse_payload("201C 10 3F800000 00000000 00000000 00000000").items, 0U);
  EXPECT_EQ(parse_payload("201C 02 0000").items, 0U);
}

TEST(MtData2, CoordinateBitsOnAnItemWithoutThemMakeItUnknown) {
  EXPECT_EQ(parse_payload("4024 0C 3F800000 00000000 00000000").items, 0U);
  EXPECT_EQ(parse_payload("1024 02 0001").items, 0U);
  EXPECT_EQ(parse_payload("1021 02 0001").items, 0U);
  EXPECT_EQ(parse_payload("3011 04 00000001").items, 0U);
}

TEST(MtData2, RotationMatrixIsKeptColumnByColumn) {
  const MtMeasurement m = parse_payload(
      "2020 24 3F800000 40000000 40400000 40800000 40A00000 40C00000 40E00000 41000000 41100000");
  expect_near(m.rotation_matrix.value, {1, 2, 3, 4, 5, 6, 7, 8, 9}, 0);
}

TEST(MtData2, ItemsWithoutPublicRecording) {
  const MtMeasurement m = parse_payload(
      "1030 04 00000102  10A0 08 0102030405060708  10B0 04 00010000  5010 04 3F800000"
      "5030 0C 3F800000 40000000 40400000  4040 0C 3F800000 40000000 40400000"
      "8040 0C 40400000 40000000 3F800000");
  EXPECT_EQ(m.itow_ms, 258U);
  EXPECT_EQ(m.sample_time64, 0x0102030405060708U);
  EXPECT_EQ(m.packet_counter32, 65536U);
  EXPECT_EQ(m.altitude_msl_m[0], 1.0);
  expect_near(m.position_ecef_m, {1, 2, 3}, 0);
  expect_near(m.acceleration_hr_m_s2, {1, 2, 3}, 0);
  expect_near(m.rate_of_turn_hr_rad_s, {3, 2, 1}, 0);
}

TEST(MtData2, UnknownItemsAreSkippedByTheirSize) {
  const MtMeasurement m = parse_payload("7777 05 FAFF360001  1020 02 0007  0000 00");
  EXPECT_EQ(m.packet_counter, 7);
  EXPECT_EQ(m.items, MtMeasurement::bit(MtItem::packet_counter));
}

TEST(MtData2, GnssDataOfAnotherFirmwareIsSkipped) {
  ByteVector payload = hex("7010 4C");
  payload.resize(payload.size() + 0x4C);
  MtMeasurement m;
  EXPECT_EQ(parse_mtdata2(payload, m), PayloadStatus::ok);
  EXPECT_FALSE(m.has(MtItem::gnss_pvt));
}

TEST(MtData2, EmptyPayloadIsAnEmptyMeasurement) {
  MtMeasurement m;
  m.packet_counter = 9;
  m.add(MtItem::packet_counter);
  EXPECT_EQ(parse_mtdata2({}, m), PayloadStatus::ok);
  EXPECT_EQ(m.items, 0U);
}

TEST(MtData2, TruncatedItemRejectsThePayloadAsAWhole) {
  MtMeasurement m;
  EXPECT_EQ(parse_mtdata2(hex("1020 02 0007  4020 0C 3F800000"), m), PayloadStatus::truncated);
  EXPECT_EQ(m.items, 0U);
  EXPECT_EQ(m.packet_counter, 0);
}

TEST(MtData2, EveryTruncationIsRejectedExceptBetweenItems) {
  for (const std::string_view text : test::kInertialMessages) {
    const ByteVector payload = payload_of(hex(text));
    std::set<std::size_t> boundaries = {0};
    for (std::size_t at = 0; at < payload.size();) {
      at += 3 + static_cast<std::size_t>(payload[at + 2]);
      boundaries.insert(at);
    }
    ASSERT_GE(boundaries.size(), 5U);
    for (std::size_t size = 0; size <= payload.size(); ++size) {
      MtMeasurement m;
      const PayloadStatus status = parse_mtdata2(wire::Bytes(payload).first(size), m);
      const bool whole = boundaries.count(size) != 0;
      EXPECT_EQ(status, whole ? PayloadStatus::ok : PayloadStatus::truncated) << size;
      if (!whole) {
        EXPECT_EQ(m.items, 0U);
      }
    }
  }
}

struct SizedType {
  std::uint16_t data_id;
  std::size_t size;
};
constexpr SizedType kSizedTypes[] = {
    {0x0810, 4},  {0x0811, 4},  {0x0812, 6},  {0x0813, 8},  {0x1010, 12}, {0x1020, 2},
    {0x1030, 4},  {0x1060, 4},  {0x1070, 4},  {0x10A0, 8},  {0x10B0, 4},  {0x2010, 16},
    {0x2011, 16}, {0x2012, 24}, {0x2013, 32}, {0x2016, 24}, {0x2020, 36}, {0x2023, 72},
    {0x2030, 12}, {0x203A, 18}, {0x3010, 4},  {0x4010, 12}, {0x4020, 12}, {0x4022, 18},
    {0x4030, 12}, {0x4040, 12}, {0x5010, 4},  {0x5020, 4},  {0x5030, 12}, {0x5042, 12},
    {0x8020, 12}, {0x8030, 16}, {0x8040, 12}, {0xC020, 12}, {0xD010, 12}, {0xD013, 24},
    {0xE010, 1},  {0xE020, 4},
};

TEST(MtData2, EveryKnownItemIsAcceptedAtExactlyOneSize) {
  for (const SizedType type : kSizedTypes) {
    for (std::size_t size = 0; size <= 100; ++size) {
      ByteVector payload = {static_cast<std::byte>(type.data_id >> 8U),
                            static_cast<std::byte>(type.data_id), static_cast<std::byte>(size)};
      payload.resize(3 + size);
      MtMeasurement m;
      const bool right = size == type.size;
      EXPECT_EQ(parse_mtdata2(payload, m), right ? PayloadStatus::ok : PayloadStatus::wrong_size)
          << std::hex << type.data_id << std::dec << " of size " << size;
      EXPECT_EQ(m.items != 0, right);
    }
  }
}

TEST(MtData2, WrongSizeRejectsThePayloadAsAWhole) {
  MtMeasurement m;
  EXPECT_EQ(parse_mtdata2(hex("1020 02 0007  2010 04 3F800000"), m), PayloadStatus::wrong_size);
  EXPECT_EQ(m.items, 0U);
}

TEST(MtDataId, IsDescribedForPeople) {
  EXPECT_EQ(describe_data_id(0x2010), "Quaternion, float32, ENU");
  EXPECT_EQ(describe_data_id(0x2036), "EulerAngles, fp16.32, NED");
  EXPECT_EQ(describe_data_id(0x4023), "Acceleration, float64");
  EXPECT_EQ(describe_data_id(0x1020), "PacketCounter");
  EXPECT_EQ(describe_data_id(0x1021), "unknown");
  EXPECT_EQ(describe_data_id(0x201C), "unknown");
  EXPECT_EQ(describe_data_id(0x4024), "unknown");
}

}  // namespace
}  // namespace convexcut::xsens
