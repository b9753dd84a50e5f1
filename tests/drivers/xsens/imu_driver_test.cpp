// SPDX-License-Identifier: Apache-2.0
//
// Bytes to samples. Does not prove that a real line's delays are those of its bit rate.
#include "drivers/xsens/imu_driver.hpp"

#include <gtest/gtest.h>

#include "drivers/xsens/error_code.hpp"
#include "tests/drivers/xsens/frames.hpp"
#include "tests/drivers/xsens/recording_sink.hpp"

namespace convexcut::xsens {
namespace {

using convexcut::test::RecordingSink;
using test::append;
using test::ByteVector;
using test::hex;
using test::make_data_message;

constexpr HostTime kStamp = from_ns<HostTime>(1'700'000'000'000'000'000);

struct Rig {
  explicit Rig(ImuDriverOptions options = {},
               std::size_t capacity = std::numeric_limits<std::size_t>::max())
      : sink(capacity), driver(options, sink) {}
  const std::vector<ImuSample>& feed(const ByteVector& bytes, HostTime stamp = kStamp) {
    driver.on_bytes(bytes, stamp);
    return sink.samples;
  }
  [[nodiscard]] const ImuCounters& counters() const { return driver.counters(); }
  RecordingSink sink;
  ImuDriver driver;
};

ByteVector counted_message(unsigned count) {
  ByteVector frame = make_data_message("1020 02 0000  4020 0C 00000000 00000000 00000000");
  frame[kHeaderSize + 3] = static_cast<std::byte>(count >> 8U);
  frame[kHeaderSize + 4] = static_cast<std::byte>(count);
  test::seal(frame);
  return frame;
}

TEST(ImuDriver, RealMessageBecomesASample) {
  Rig rig;
  const auto& samples = rig.feed(hex(test::kImuSetMessage));
  ASSERT_EQ(samples.size(), 1U);
  const ImuSample& s = samples[0];
  EXPECT_TRUE(s.has_orientation && s.has_angular_velocity && s.has_acceleration);
  EXPECT_TRUE(s.has_status && s.has_counter && s.has_device_time);
  EXPECT_NEAR(s.q_level_from_imu.w(), .99818522, 1e-7);
  EXPECT_NEAR(s.q_level_from_imu.norm(), 1.0, 1e-15);
  EXPECT_FLOAT_EQ(s.acceleration_m_s2.z(), 9.81525326F);
  EXPECT_FLOAT_EQ(s.angular_velocity_rad_s.y(), -.00810772F);
  EXPECT_EQ(s.status, 0x00400003U);
  EXPECT_EQ(s.counter, 36240);
  EXPECT_EQ(to_ns(s.device_time), 5'561'329LL * 100'000);
}

TEST(ImuDriver, AbsentItemsKeepTheirDefaultsInADirtySlot) {
  Rig rig;
  const ImuSample s = rig.feed(make_data_message("8020 0C 3F800000 00000000 00000000")).at(0);
  EXPECT_TRUE(s.has_angular_velocity);
  EXPECT_FALSE(s.has_orientation || s.has_acceleration || s.has_status || s.has_counter ||
               s.has_device_time);
  EXPECT_EQ(s.acceleration_m_s2, Vec3f::Zero());
  EXPECT_EQ(s.status, 0U);
  EXPECT_EQ(s.counter, 0);
}

TEST(ImuDriver, EulerAnglesAndStatusByteServeWhereTheOthersAreAbsent) {
  Rig rig;
  const ImuSample s = rig.feed(hex(test::kFp1220Message)).at(0);
  const Quaternion expected =
      to_quaternion({Degrees{-99.764153}, Degrees{-0.239947}, Degrees{178.621353}});
  EXPECT_NEAR(s.q_level_from_imu.angularDistance(expected), 0, 1e-7);
  EXPECT_EQ(s.status, 5U);
}

TEST(ImuDriver, HighRateItemsServeWhereTheOthersAreAbsent) {
  Rig rig;
  rig.feed(make_data_message("4040 0C 3F800000 00000000 00000000"));
  rig.feed(
      make_data_message("4040 0C 3F800000 00000000 00000000  4020 0C 40000000 00000000 00000000"));
  ASSERT_EQ(rig.sink.samples.size(), 2U);
  EXPECT_EQ(rig.sink.samples[0].acceleration_m_s2.x(), 1.0F);
  EXPECT_EQ(rig.sink.samples[1].acceleration_m_s2.x(), 2.0F);
}

TEST(ImuDriver, ArrivalIsTheStampLessTheLineTimeOfTheFrame) {
  Rig rig({.baud = 115200});
  const ByteVector frame = hex(test::kQuaternionMessage);
  EXPECT_EQ(rig.feed(frame).at(0).arrival, kStamp - line_time(frame.size(), 115200));
}

TEST(ImuDriver, ArrivalOfAFrameInsideAChunkIsBackDatedByTheBytesBehindIt) {
  Rig rig({.baud = 115200});
  const ByteVector first = hex(test::kQuaternionMessage);
  const ByteVector second = hex(test::kImuSetMessage);
  ByteVector chunk = first;
  append(chunk, second);
  append(chunk, hex("FA FF"));
  const auto& samples = rig.feed(chunk);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[0].arrival, kStamp - line_time(chunk.size(), 115200));
  EXPECT_EQ(samples[1].arrival, kStamp - line_time(second.size() + 2, 115200));
}

TEST(ImuDriver, WithoutALineRateArrivalIsTheStamp) {
  Rig rig({.baud = 0});
  EXPECT_EQ(rig.feed(hex(test::kQuaternionMessage)).at(0).arrival, kStamp);
}

TEST(ImuDriver, FrameAcrossChunksHasTheStampOfItsLastByte) {
  Rig rig({.baud = 0});
  const ByteVector frame = hex(test::kQuaternionMessage);
  rig.driver.on_bytes(wire::Bytes(frame).first(20), kStamp - std::chrono::seconds{1});
  rig.driver.on_bytes(wire::Bytes(frame).subspan(20), kStamp);
  EXPECT_EQ(rig.sink.samples.at(0).arrival, kStamp);
}

TEST(ImuDriver, UnstampedSamplesFollowTheDevicesTime) {
  const HostTime start = from_ns<HostTime>(5'000'000'000);
  Rig rig({.baud = 115200, .unstamped_start = start});
  rig.feed(make_data_message("1060 04 00000BB8"));  // no sample: does not set the start
  rig.feed(make_data_message("1060 04 000003E8  4020 0C 00000000 00000000 00000000"));
  rig.feed(make_data_message("1060 04 0000044C  4020 0C 00000000 00000000 00000000"));
  ASSERT_EQ(rig.sink.samples.size(), 2U);
  EXPECT_EQ(rig.sink.samples[0].arrival, start);
  EXPECT_EQ(rig.sink.samples[1].arrival, start + std::chrono::milliseconds{10});
}

TEST(ImuDriver, UnstampedSamplesWithoutDeviceTimeAreDroppedAndCounted) {
  Rig rig({.unstamped_start = HostTime{}});
  EXPECT_TRUE(rig.feed(counted_message(1)).empty());
  EXPECT_EQ(rig.counters().no_device_time.value(), 1U);
}

TEST(ImuDriver, StampedSamplesNeedNoDeviceTime) {
  Rig rig;
  EXPECT_FALSE(rig.feed(counted_message(1)).at(0).has_device_time);
}

TEST(ImuDriver, MessageWithoutInertialDataMakesNoSample) {
  Rig rig;
  EXPECT_TRUE(rig.feed(hex(test::kNoInertialMessage)).empty());
  EXPECT_EQ(rig.counters().without_inertial.value(), 1U);
  EXPECT_EQ(rig.counters().data_messages.value(), 1U);
}

TEST(ImuDriver, DayWrapInAMessageWithoutInertialDataIsNotMissed) {
  Rig rig;
  const std::string acceleration = " 4020 0C 00000000 00000000 00000000";
  rig.feed(make_data_message("1060 04 337F97CE" + acceleration));  // a day less 50 ticks
  rig.feed(make_data_message("1060 04 00000032"));
  rig.feed(make_data_message("1060 04 00000096" + acceleration));
  ASSERT_EQ(rig.sink.samples.size(), 2U);
  EXPECT_EQ(rig.sink.samples[1].device_time - rig.sink.samples[0].device_time,
            std::chrono::milliseconds{20});
}

TEST(ImuDriver, MissingPacketCountersAreLostMessages) {
  Rig rig;
  for (const unsigned count : {65533U, 65534U, 1U, 2U}) rig.feed(counted_message(count));
  EXPECT_EQ(rig.counters().lost_messages.value(), 2U);  // 65535 and 0
  EXPECT_EQ(rig.counters().counter_restarts.value(), 0U);
}

TEST(ImuDriver, ACounterThatRepeatsOrGoesBackIsARestartNotALoss) {
  Rig rig;
  for (const unsigned count : {40000U, 40001U, 40001U, 39000U, 39001U}) {
    rig.feed(counted_message(count));
  }
  EXPECT_EQ(rig.counters().lost_messages.value(), 0U);
  EXPECT_EQ(rig.counters().counter_restarts.value(), 2U);
}

TEST(ImuDriver, CounterOfAMessageWithoutInertialDataCounts) {
  Rig rig;
  rig.feed(counted_message(1));
  rig.feed(make_data_message("1020 02 0002"));
  rig.feed(counted_message(3));
  EXPECT_EQ(rig.counters().lost_messages.value(), 0U);
}

TEST(ImuDriver, ErrorMessageIsCountedWithItsCode) {
  Rig rig;
  EXPECT_TRUE(rig.feed(hex(test::kErrorInvalidParameter)).empty());
  EXPECT_EQ(rig.counters().error_messages.value(), 1U);
  EXPECT_EQ(rig.counters().last_error.load(), 0x21);
  EXPECT_EQ(describe_error(0x21), "invalid parameter");
  rig.feed(test::make_frame(0x42, {}));
  EXPECT_EQ(rig.counters().error_messages.value(), 2U);
}

TEST(ImuDriver, OtherMessagesAreSkippedAndCounted) {
  Rig rig;
  std::size_t others = 0;
  for (const std::string_view frame : test::kAllFrames) {
    const auto id = static_cast<std::uint8_t>(hex(frame)[kMessageIdOffset]);
    if (id == 0x36 || id == 0x42) continue;
    rig.feed(hex(frame));
    ++others;
  }
  EXPECT_EQ(others, 23U);
  EXPECT_EQ(rig.counters().other_messages.value(), others);
  EXPECT_TRUE(rig.sink.samples.empty());
}

TEST(ImuDriver, ConfigurationMessagesAtStartUpDoNotHideMeasurements) {
  Rig rig;
  ByteVector stream = hex(test::kWakeUp);
  append(stream, test::make_frame(0x0D, ByteVector(118, std::byte{0xFA})));
  append(stream, test::make_frame(0x91, ByteVector(400, std::byte{0xFF})));
  append(stream, hex(test::kQuaternionMessage));
  EXPECT_EQ(rig.feed(stream).size(), 1U);
  EXPECT_EQ(rig.counters().other_messages.value(), 3U);
  EXPECT_EQ(rig.counters().xbus.skipped_bytes.value(), 0U);
}

TEST(ImuDriver, LegacyDataMessageIsNotMisread) {
  Rig rig;
  EXPECT_TRUE(rig.feed(test::make_frame(0x32, ByteVector(43))).empty());
  EXPECT_EQ(rig.counters().other_messages.value(), 1U);
}

TEST(ImuDriver, ZeroQuaternionIsSentOnWithoutOrientation) {
  Rig rig;
  const ImuSample s =
      rig.feed(make_data_message("2010 10 00000000 00000000 00000000 00000000")).at(0);
  EXPECT_FALSE(s.has_orientation);
  EXPECT_EQ(rig.counters().values.invalid_orientations.value(), 1U);
}

TEST(ImuDriver, NotANumberNeverGetsIntoASample) {
  Rig rig;
  const ImuSample s =
      rig.feed(make_data_message(
                   "4020 0C 7FC00000 00000000 00000000  8020 0C 00000000 7F800000 00000000"
                   "2010 10 7FC00000 00000000 00000000 00000000"))
          .at(0);
  EXPECT_FALSE(s.has_acceleration || s.has_angular_velocity || s.has_orientation);
  EXPECT_TRUE(s.acceleration_m_s2.isZero() && s.angular_velocity_rad_s.isZero());
  EXPECT_EQ(rig.counters().values.invalid_vectors.value(), 2U);
}

TEST(ImuDriver, Float64BeyondFloatIsInvalid) {
  Rig rig;
  const ImuSample s =
      rig.feed(make_data_message("4023 18 7FE0000000000000 0000000000000000 0000000000000000"))
          .at(0);
  EXPECT_FALSE(s.has_acceleration);
  EXPECT_EQ(rig.counters().values.invalid_vectors.value(), 1U);
}

TEST(ImuDriver, FullSinkIsCountedAndNothingElseIsLost) {
  Rig rig({}, 1);
  rig.feed(counted_message(1));
  rig.feed(counted_message(2));
  EXPECT_EQ(rig.sink.samples.size(), 1U);
  EXPECT_EQ(rig.counters().samples.value(), 1U);
  EXPECT_EQ(rig.counters().sink_full.value(), 1U);
}

// Every payload length with a good checksum: a sample where the cut falls between items and what
// is left holds inertial data, otherwise nothing but a count.
TEST(ImuDriver, EveryLengthOfEveryMessageIsASampleOrACount) {
  for (const std::string_view text : test::kInertialMessages) {
    const ByteVector payload = test::payload_of(hex(text));
    for (std::size_t size = 0; size <= 300; ++size) {
      ByteVector resized = payload;
      resized.resize(size);  // zeros behind it are unknown items of three bytes
      Rig rig;
      rig.feed(test::make_frame(0x36, resized));
      MtMeasurement m;
      const bool whole = parse_mtdata2(resized, m) == PayloadStatus::ok;
      const std::size_t expected = whole && makes_sample(m) ? 1 : 0;
      ASSERT_EQ(rig.sink.samples.size(), expected) << size;
      ASSERT_EQ(rig.counters().truncated_payloads.value(), whole ? 0U : 1U) << size;
      ASSERT_EQ(rig.counters().xbus.frames.value(), 1U) << size;
      if (size > payload.size()) {
        ASSERT_EQ(whole, (size - payload.size()) % 3 == 0) << size;
      }
    }
  }
}

TEST(ImuDriver, KnownItemOfAnotherSizeDropsTheMessage) {
  Rig rig;
  EXPECT_TRUE(
      rig.feed(make_data_message("4020 0C 00000000 00000000 00000000  2010 04 3F800000")).empty());
  EXPECT_EQ(rig.counters().wrong_item_sizes.value(), 1U);
}

TEST(ImuDriver, OneByteReadsGiveTheSamplesOfOneRead) {
  ByteVector stream;
  for (const std::string_view frame : test::kAllFrames) append(stream, hex(frame));
  Rig whole({.baud = 0});
  whole.feed(stream);
  Rig bytewise({.baud = 0});
  for (const std::byte b : stream) bytewise.feed({b});
  ASSERT_EQ(whole.sink.samples.size(), test::kInertialMessages.size());
  ASSERT_EQ(bytewise.sink.samples.size(), whole.sink.samples.size());
  for (std::size_t i = 0; i < whole.sink.samples.size(); ++i) {
    const ImuSample& a = whole.sink.samples[i];
    const ImuSample& b = bytewise.sink.samples[i];
    EXPECT_EQ(a.arrival, b.arrival);
    EXPECT_EQ(a.device_time, b.device_time);
    EXPECT_EQ(a.counter, b.counter);
    EXPECT_EQ(a.q_level_from_imu.coeffs(), b.q_level_from_imu.coeffs());
    EXPECT_EQ(a.acceleration_m_s2, b.acceleration_m_s2);
    EXPECT_EQ(a.angular_velocity_rad_s, b.angular_velocity_rad_s);
  }
}

TEST(ErrorCode, TellsTheOneThatMattersMost) {
  EXPECT_EQ(describe_error(41), "data overflow: baud rate too low for the configuration");
  EXPECT_EQ(describe_error(17), "bus initialisation failed");
  EXPECT_EQ(describe_error(200), "unknown error");
}

}  // namespace
}  // namespace convexcut::xsens
