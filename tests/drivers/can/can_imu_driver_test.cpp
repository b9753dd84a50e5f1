// SPDX-License-Identifier: Apache-2.0
//
// Grouping of frames into samples. Does not prove in which order a real device sends the frames of
// a group: several orders are covered.
#include "drivers/can/can_imu_driver.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "tests/drivers/can/frames.hpp"
#include "tests/drivers/xsens/recording_sink.hpp"

namespace convexcut::can {
namespace {

using convexcut::test::RecordingSink;
using test::make_frame;

constexpr HostTime kStart = from_ns<HostTime>(1'700'000'000'000'000'000);
constexpr Duration kPeriod = std::chrono::milliseconds{10};
constexpr Duration kFrameGap = std::chrono::microseconds{500};

struct Rig {
  explicit Rig(CanImuOptions options = {},
               std::size_t capacity = std::numeric_limits<std::size_t>::max())
      : sink(capacity), driver(options, sink) {}

  // Frames come 0.5 ms after one another unless at() says otherwise.
  Rig& send(std::uint32_t id, std::string_view data_hex) {
    driver.on_frame(make_frame(id, data_hex, now));
    now += kFrameGap;
    return *this;
  }
  Rig& at(HostTime time) {
    now = time;
    return *this;
  }
  Rig& time(std::uint32_t us) {
    CanFrame frame = make_frame(0x005, "00000000", now);
    for (unsigned i = 0; i < 4; ++i) frame.data[i] = static_cast<std::byte>(us >> (24 - 8 * i));
    driver.on_frame(frame);
    now += kFrameGap;
    return *this;
  }
  Rig& count(unsigned value) {
    CanFrame frame = make_frame(0x006, "0000", now);
    frame.data[0] = static_cast<std::byte>(value >> 8U);
    frame.data[1] = static_cast<std::byte>(value);
    driver.on_frame(frame);
    now += kFrameGap;
    return *this;
  }
  Rig& quaternion() { return send(0x021, "7FFF 0000 0000 0000"); }
  Rig& rate() { return send(0x032, "0064 FF9C 0000"); }
  Rig& acceleration() { return send(0x034, "0000 0000 09CF"); }
  // One full group, 10 ms after the one of the number before it.
  Rig& group(unsigned n) {
    at(kStart + n * kPeriod).time(10'000 * n).count(n);
    return send(0x011, "00400003").quaternion().rate().acceleration();
  }
  Rig& end() {
    driver.flush();
    return *this;
  }
  [[nodiscard]] const CanImuCounters& counters() const { return driver.counters(); }
  [[nodiscard]] const std::vector<ImuSample>& samples() const { return sink.samples; }

  HostTime now = kStart;
  RecordingSink sink;
  CanImuDriver driver;
};

TEST(CanImuDriver, OneGroupIsOneSample) {
  Rig rig;
  rig.group(7).end();
  ASSERT_EQ(rig.samples().size(), 1U);
  const ImuSample& s = rig.samples()[0];
  EXPECT_TRUE(s.has_orientation && s.has_angular_velocity && s.has_acceleration);
  EXPECT_TRUE(s.has_status && s.has_counter && s.has_device_time);
  EXPECT_NEAR(s.q_level_from_imu.angularDistance(Quaternion::Identity()), 0, 1e-12);
  EXPECT_EQ(s.angular_velocity_rad_s, Vec3f(0.1953125F, -0.1953125F, 0));
  EXPECT_EQ(s.acceleration_m_s2, Vec3f(0, 0, 2511 / 256.0F));
  EXPECT_EQ(s.status, 0x00400003U);
  EXPECT_EQ(s.counter, 7);
  EXPECT_EQ(to_ns(s.device_time), 70'000'000);
}

TEST(CanImuDriver, QuaternionIsRenormalised) {
  Rig rig;
  rig.time(0).send(0x021, "5A82 5A82 0000 0000").end();
  EXPECT_NEAR(rig.samples().at(0).q_level_from_imu.norm(), 1.0, 1e-15);
}

TEST(CanImuDriver, ArrivalIsTheStampOfTheFirstFrameLessItsBusTime) {
  Rig rig({.bitrate = 250'000});
  rig.group(0).end();
  // SampleTime: 44 + 32 bits.
  EXPECT_EQ(rig.samples().at(0).arrival, kStart - std::chrono::microseconds{304});
}

TEST(CanImuDriver, FirstSamplesComeWithTheNextGroup) {
  Rig rig;
  rig.group(0);
  EXPECT_TRUE(rig.samples().empty()) << "nobody knows yet what a group holds";
  rig.at(kStart + kPeriod).time(10'000);
  EXPECT_EQ(rig.samples().size(), 1U);
}

TEST(CanImuDriver, LaterSamplesComeWithTheirLastFrame) {
  Rig rig;
  rig.group(0).group(1);
  EXPECT_EQ(rig.samples().size(), 2U);
  rig.at(kStart + 2 * kPeriod).time(20'000).count(2).send(0x011, "00400003").quaternion().rate();
  EXPECT_EQ(rig.samples().size(), 2U);
  rig.acceleration();
  EXPECT_EQ(rig.samples().size(), 3U);
  rig.end();
  EXPECT_EQ(rig.samples().size(), 3U) << "not twice";
}

TEST(CanImuDriver, ALostFrameDoesNotCutTheNextSampleShort) {
  Rig rig;
  rig.group(0).group(1);
  rig.at(kStart + 2 * kPeriod).time(20'000).count(2).send(0x011, "00400003").quaternion().rate();
  rig.group(3).group(4).end();
  ASSERT_EQ(rig.samples().size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(rig.samples()[i].has_acceleration, i != 2) << i;
    EXPECT_EQ(rig.samples()[i].counter, i);
  }
  EXPECT_EQ(rig.counters().late_frames.value(), 0U);
}

TEST(CanImuDriver, AMessageThatTheDeviceAddsIsLateOnceAndThenBelongs) {
  Rig rig;
  for (unsigned n = 0; n < 5; ++n) {
    rig.at(kStart + n * kPeriod).time(10'000 * n).count(n).quaternion();
    if (n >= 2) rig.acceleration();
  }
  rig.end();
  ASSERT_EQ(rig.samples().size(), 5U);
  EXPECT_FALSE(rig.samples()[2].has_acceleration);
  EXPECT_TRUE(rig.samples()[3].has_acceleration);
  EXPECT_TRUE(rig.samples()[4].has_acceleration);
  EXPECT_EQ(rig.counters().late_frames.value(), 1U);
}

TEST(CanImuDriver, CounterMayComeFirstOrBehindTheData) {
  Rig first;
  Rig last;
  for (unsigned n = 0; n < 3; ++n) {
    first.at(kStart + n * kPeriod).count(n).time(10'000 * n).quaternion();
    last.at(kStart + n * kPeriod).time(10'000 * n).quaternion().count(n);
  }
  first.end();
  last.end();
  for (const Rig* rig : {&first, &last}) {
    ASSERT_EQ(rig->samples().size(), 3U);
    for (std::size_t n = 0; n < 3; ++n) {
      EXPECT_EQ(rig->samples()[n].counter, n);
      EXPECT_EQ(to_ns(rig->samples()[n].device_time), static_cast<std::int64_t>(n) * 10'000'000);
    }
  }
}

TEST(CanImuDriver, CounterAloneSeparatesGroups) {
  Rig rig;
  for (unsigned n = 0; n < 3; ++n) rig.count(n).quaternion().rate();
  rig.end();
  ASSERT_EQ(rig.samples().size(), 3U);
  EXPECT_FALSE(rig.samples()[0].has_device_time);
  EXPECT_EQ(rig.counters().groups_without_time.value(), 3U);
}

TEST(CanImuDriver, WithoutAnyHeaderARepeatedMessageSeparatesGroups) {
  Rig rig;
  for (int n = 0; n < 3; ++n) rig.quaternion().rate();
  rig.end();
  EXPECT_EQ(rig.samples().size(), 3U);
  EXPECT_EQ(rig.counters().groups.value(), 3U);
}

TEST(CanImuDriver, APauseEndsAGroup) {
  Rig rig;
  rig.at(kStart).time(0).quaternion();
  rig.at(kStart + std::chrono::milliseconds{21}).rate().end();
  ASSERT_EQ(rig.samples().size(), 2U);
  EXPECT_FALSE(rig.samples()[0].has_angular_velocity);
  EXPECT_FALSE(rig.samples()[1].has_orientation);
}

TEST(CanImuDriver, FramesWithinTheTimeoutStayTogether) {
  Rig rig;
  rig.at(kStart).time(0).quaternion();
  rig.at(kStart + std::chrono::milliseconds{20}).rate().end();
  EXPECT_EQ(rig.samples().size(), 1U);
}

TEST(CanImuDriver, AStepBackOfTheHostsClockEndsAGroup) {
  Rig rig;
  rig.at(kStart).time(0).quaternion();
  rig.at(kStart - std::chrono::seconds{1}).rate().end();
  EXPECT_EQ(rig.samples().size(), 2U);
}

TEST(CanImuDriver, SampleTimeWrapsAfterSeventyOneMinutes) {
  Rig rig;
  rig.time(0xFFFFFFFF - 4'999).quaternion().time(5'000).quaternion().end();
  ASSERT_EQ(rig.samples().size(), 2U);
  EXPECT_EQ(rig.samples()[1].device_time - rig.samples()[0].device_time, kPeriod);
}

TEST(CanImuDriver, MissingGroupCountersAreLostGroups) {
  Rig rig;
  for (const unsigned n : {65534U, 65535U, 2U}) rig.count(n).quaternion();
  EXPECT_EQ(rig.counters().lost_groups.value(), 2U);  // 0 and 1
  EXPECT_EQ(rig.counters().counter_restarts.value(), 0U);
}

TEST(CanImuDriver, HighRateFramesDoNotDisturbGroups) {
  Rig rig;
  rig.send(0x061, "000000000000");
  for (unsigned n = 0; n < 3; ++n) {
    rig.time(10'000 * n).count(n);
    rig.send(0x061, "020000000000").quaternion().send(0x061, "020000000000");
    rig.send(0x062, "010000000000").rate().send(0x062, "010000000000");
  }
  rig.end();
  ASSERT_EQ(rig.samples().size(), 3U);
  EXPECT_EQ(rig.samples()[0].angular_velocity_rad_s.x(), 0.1953125F) << "not the high-rate one";
  EXPECT_EQ(rig.counters().stray_frames.value(), 1U);
  EXPECT_EQ(rig.counters().late_frames.value(), 0U);
}

TEST(CanImuDriver, GroupWithoutInertialDataMakesNoSample) {
  Rig rig;
  rig.time(0).count(0).send(0x051, "1980").end();
  EXPECT_TRUE(rig.samples().empty());
  EXPECT_EQ(rig.counters().groups_without_inertial.value(), 1U);
}

TEST(CanImuDriver, DataAfterGroupsOfHeadersOnlyIsNotLate) {
  Rig rig;
  rig.time(0).count(0).time(10'000).count(1).time(20'000).count(2);
  rig.time(30'000).count(3).quaternion().end();
  EXPECT_EQ(rig.samples().size(), 1U);
  EXPECT_EQ(rig.counters().late_frames.value(), 0U);
}

TEST(CanImuDriver, ZeroQuaternionIsSentOnWithoutOrientation) {
  Rig rig;
  rig.time(0).send(0x021, "0000000000000000").end();
  ASSERT_EQ(rig.samples().size(), 1U);
  EXPECT_FALSE(rig.samples()[0].has_orientation);
  EXPECT_EQ(rig.counters().values.invalid_orientations.value(), 1U);
}

TEST(CanImuDriver, AllOnesIsAnOrdinaryValue) {
  Rig rig;
  rig.time(0).send(0x032, "FFFFFFFFFFFF").end();
  EXPECT_EQ(rig.samples().at(0).angular_velocity_rad_s.x(), -0x1p-9F);
}

TEST(CanImuDriver, OtherFramesAreCountedByReasonAndMakeNothing) {
  Rig rig;
  CanFrame frame = make_frame(0x021, "7FFF000000000000");
  frame.remote = true;
  rig.driver.on_frame(frame);
  frame.remote = false;
  frame.extended = true;
  rig.driver.on_frame(frame);
  frame.extended = false;
  frame.fd = true;
  rig.driver.on_frame(frame);
  frame = make_frame(0x040, "0000000000000000");
  frame.error = true;
  rig.driver.on_frame(frame);
  frame.id = 0x200;
  rig.driver.on_frame(frame);
  rig.send(0x123, "00").send(0x034, "0000000009").end();
  EXPECT_TRUE(rig.samples().empty());
  EXPECT_EQ(rig.counters().frames.value(), 7U);
  EXPECT_EQ(rig.counters().remote_frames.value(), 1U);
  EXPECT_EQ(rig.counters().foreign_frames.value(), 3U);
  EXPECT_EQ(rig.counters().error_frames.value(), 2U);
  EXPECT_EQ(rig.counters().bus_off.value(), 1U);
  EXPECT_EQ(rig.counters().short_frames.value(), 1U);
  EXPECT_EQ(rig.counters().groups.value(), 0U);
}

TEST(CanImuDriver, LongerFramesThanExpectedAreTaken) {
  Rig rig;
  rig.time(0).send(0x034, "0000000009CFAAAA").end();
  EXPECT_TRUE(rig.samples().at(0).has_acceleration);
}

TEST(CanImuDriver, DeviceErrorsAndWarningsAreCountedOutsideGroups) {
  Rig rig;
  rig.time(0).quaternion().send(0x001, "01").send(0x002, "01").rate().end();
  EXPECT_EQ(rig.samples().size(), 1U);
  EXPECT_EQ(rig.counters().device_errors.value(), 1U);
  EXPECT_EQ(rig.counters().device_warnings.value(), 1U);
  EXPECT_EQ(rig.counters().last_error.load(), 1);
}

TEST(CanImuDriver, FullSinkIsCounted) {
  Rig rig({}, 1);
  rig.group(0).group(1).group(2).end();
  EXPECT_EQ(rig.samples().size(), 1U);
  EXPECT_EQ(rig.counters().sink_full.value(), 2U);
}

TEST(CanImuDriver, ExtendedIdsOfTheFieldAreConfigurable) {
  CanImuOptions options;
  options.ids.extended = true;
  options.ids[XsensMessage::quaternion] = 0x19FF0032;
  Rig rig(options);
  CanFrame frame = make_frame(0x19FF0032, "7FFF000000000000");
  frame.extended = true;
  rig.driver.on_frame(frame);
  rig.end();
  EXPECT_EQ(rig.samples().size(), 1U);
}

}  // namespace
}  // namespace convexcut::can
