// SPDX-License-Identifier: Apache-2.0
//
// Values that do not suit each other. Does not prove that a port is free: other programs may hold
// it.
#include "config/conflicts.hpp"

#include <array>
#include <cstdint>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/config/config_error.hpp"

namespace convexcut::config {
namespace {

using test::errors_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Conflicts, DefaultsHaveNone) { EXPECT_THAT(find_conflicts(Config{}), IsEmpty()); }

TEST(Conflicts, NearLimitIsBelowTheFarOne) {
  EXPECT_THAT(errors_of("[lidar]\nmin_range_m = 100\n"),
              ElementsAre("robot.toml:2: lidar.min_range_m: expected lidar.min_range_m < "
                          "lidar.max_range_m, found 100.0 and 100.0"));
  EXPECT_THAT(errors_of("[lidar]\nmin_range_m = 100\nmax_range_m = 100.1\n"), IsEmpty());
}

TEST(Conflicts, LastAssignmentIsToBlame) {
  EXPECT_THAT(errors_of("[lidar]\nmin_range_m = 3\nmax_range_m = 2\n"),
              ElementsAre(HasSubstr("robot.toml:3: lidar.max_range_m: ")));
  EXPECT_THAT(errors_of("[lidar]\nmin_range_m = 3\n", {"lidar.max_range_m=2"}),
              ElementsAre("--set lidar.max_range_m=2: expected lidar.min_range_m < "
                          "lidar.max_range_m, found 3.0 and 2.0"));
}

TEST(Conflicts, AreNotReportedForValuesThatWereRefused) {
  // The range that was asked for is not known, so 200 may be fine.
  EXPECT_THAT(errors_of("[lidar]\nmin_range_m = 200\nmax_range_m = 'far'\n"),
              ElementsAre(HasSubstr("robot.toml:3: lidar.max_range_m: expected a number")));
}

TEST(Conflicts, LatencyIsBelowThePeriod) {
  EXPECT_THAT(errors_of("[worker]\nlatency_ms = 100\n"),
              ElementsAre(HasSubstr("expected worker.latency_ms < worker.period_ms")));
  EXPECT_THAT(errors_of("[worker]\nlatency_ms = 99\n"), IsEmpty());
}

TEST(Conflicts, PortsDiffer) {
  EXPECT_THAT(errors_of("[lidar]\nposition_port = 2368\n"),
              ElementsAre("robot.toml:2: lidar.position_port: expected lidar.data_port and "
                          "lidar.position_port to differ, found 2368 for both"));
}

TEST(Conflicts, CanIdentifiersDiffer) {
  EXPECT_THAT(errors_of("[can]\neuler_id = 0x21\n"),
              ElementsAre("robot.toml:2: can.euler_id: expected can.quaternion_id and can.euler_id "
                          "to differ, found 0x21 for both"));
}

TEST(Conflicts, LongCanIdentifiersNeedExtendedOnes) {
  EXPECT_THAT(errors_of("[can]\nquaternion_id = 0x19ff0032\n"),
              ElementsAre("robot.toml:2: can.quaternion_id: expected at most 0x7ff without "
                          "can.extended_ids, found can.quaternion_id = 0x19ff0032"));
  EXPECT_THAT(errors_of("[can]\nquaternion_id = 0x19ff0032\nextended_ids = true\n"), IsEmpty());
  EXPECT_THAT(errors_of("[can]\nquaternion_id = 0x7ff\n"), IsEmpty());
}

TEST(Conflicts, HeadingOfAStageNeedsAnImuAndAVerticalAxis) {
  EXPECT_THAT(errors_of("[encoder]\nuse = 'yaw'\n"), IsEmpty());
  EXPECT_THAT(errors_of("[encoder]\nuse = 'yaw'\naxis = 'tilt'\n[mount]\norientation = 'fixed'\n"),
              ElementsAre("robot.toml:5: mount.orientation: expected mount.orientation = \"imu\" "
                          "with encoder.use = \"yaw\", found \"fixed\"",
                          "robot.toml:3: encoder.axis: expected encoder.axis = \"rotation\" with "
                          "encoder.use = \"yaw\", found \"tilt\""));
}

TEST(Conflicts, OrientationOfAStageNeedsAFixedMount) {
  EXPECT_THAT(errors_of("[encoder]\nuse = 'orientation'\n"),
              ElementsAre("robot.toml:2: encoder.use: expected mount.orientation = \"fixed\" with "
                          "encoder.use = \"orientation\", found \"imu\""));
  EXPECT_THAT(errors_of("[mount]\norientation = 'fixed'\n[encoder]\nuse = 'orientation'\naxis = "
                        "'tilt'\n"),
              IsEmpty());
}

TEST(Conflicts, EncoderHasAnIdentifierOfItsOwn) {
  EXPECT_THAT(errors_of("[encoder]\nuse = 'yaw'\nid = 0x21\n"),
              ElementsAre("robot.toml:3: encoder.id: expected encoder.id and can.quaternion_id to "
                          "differ, found 0x21 for both"));
  EXPECT_THAT(errors_of("[encoder]\nuse = 'yaw'\nid = 0x21\nextended_id = true\n"), IsEmpty());
  EXPECT_THAT(errors_of("[encoder]\nid = 0x21\n"), IsEmpty());  // not used
  EXPECT_THAT(errors_of("[encoder]\nuse = 'yaw'\nid = 0x800\n"),
              ElementsAre(HasSubstr("expected at most 0x7ff without encoder.extended_id")));
}

TEST(Conflicts, CountOfTheEncoderIsWithinAFrame) {
  const std::string used = "[encoder]\nuse = 'yaw'\n";
  EXPECT_THAT(errors_of(used + "start_bit = 480\n"), IsEmpty());
  EXPECT_THAT(errors_of(used + "start_bit = 481\n"),
              ElementsAre("robot.toml:3: encoder.start_bit: expected a count that ends within 64 "
                          "bytes, found 32 bits from bit 481"));
  EXPECT_THAT(errors_of(used + "start_bit = 481\npreset = 'cia402_position'\n"), IsEmpty());
  EXPECT_THAT(errors_of(used + "byte_order = 'motorola'\nstart_bit = 487\n"), IsEmpty());
  EXPECT_THAT(errors_of(used + "byte_order = 'motorola'\nstart_bit = 486\n"),
              ElementsAre(HasSubstr("ends within 64 bytes")));
}

TEST(Conflicts, CountOfTheEncoderTurnsTheStage) {
  EXPECT_THAT(errors_of("[encoder]\nuse = 'yaw'\nscale_deg = 0\n"),
              ElementsAre("robot.toml:3: encoder.scale_deg: expected another number than 0, found "
                          "0"));
}

TEST(Conflicts, TopicsAndFramesDiffer) {
  EXPECT_THAT(errors_of("[dds]\npoints_topic = 'imu/data'\nimu_frame = 'level'\n"),
              ElementsAre(HasSubstr("expected dds.points_topic and dds.imu_topic to differ"),
                          HasSubstr("expected dds.level_frame and dds.imu_frame to differ")));
}

TEST(Conflicts, LidarPortOfTheDdsDomainIsAnError) {
  EXPECT_THAT(errors_of("[lidar]\ndata_port = 7660\n[dds]\ndomain = 1\n"),
              ElementsAre("robot.toml:4: dds.domain: expected ports of the lidar that DDS does not "
                          "use, but port 7660 is used by DDS domain 1 for its participant 0"));
}

TEST(Conflicts, ImuRateDividesItsHighest) {
  EXPECT_THAT(errors_of("[imu]\nrate_hz = 300\n"),
              ElementsAre("robot.toml:2: imu.rate_hz: expected a divisor of 400, found 300"));
  EXPECT_THAT(errors_of("[imu]\nrate_hz = 80\n"), IsEmpty());
}

TEST(Conflicts, ConfiguredImuNeedsALineThatIsFastEnough) {
  EXPECT_THAT(errors_of("[imu]\nconfigure = true\nset_baud = 0\n"),
              ElementsAre("robot.toml:3: imu.set_baud: expected a line of at least 292000 bit/s "
                          "for 400 Hz, found 115200: set imu.set_baud, or a lower imu.rate_hz"));
  EXPECT_THAT(errors_of("[imu]\nconfigure = true\n"), IsEmpty());
  EXPECT_THAT(errors_of("[imu]\nconfigure = true\nset_baud = 0\nrate_hz = 100\n"), IsEmpty());
  EXPECT_THAT(errors_of("[imu]\nset_baud = 0\n"), IsEmpty());  // not configured
  EXPECT_THAT(errors_of("[imu]\nconfigure = true\nset_baud = 0\nbaud = 0\n"), IsEmpty());  // USB
}

TEST(PortCollision, MulticastPortsOfADomain) {
  EXPECT_EQ(port_collision(0, 7400, 8308), "port 7400 is used by DDS domain 0 for multicast");
  EXPECT_EQ(port_collision(0, 2368, 7401), "port 7401 is used by DDS domain 0 for multicast");
  EXPECT_EQ(port_collision(2, 7900, 8308), "port 7900 is used by DDS domain 2 for multicast");
}

TEST(PortCollision, UnicastPortsOfParticipants) {
  EXPECT_EQ(port_collision(0, 7410, 1), "port 7410 is used by DDS domain 0 for its participant 0");
  EXPECT_EQ(port_collision(0, 7413, 1), "port 7413 is used by DDS domain 0 for its participant 1");
  EXPECT_EQ(port_collision(0, 7475, 1), "port 7475 is used by DDS domain 0 for its participant 32");
}

TEST(PortCollision, PortsThatNoParticipantOfTheDomainUses) {
  for (const std::uint16_t port : std::array<std::uint16_t, 5>{7399, 7402, 7409, 7476, 7650}) {
    EXPECT_EQ(port_collision(0, port, 8308), std::nullopt) << port;
  }
}

TEST(PortCollision, DefaultPortsSuitEveryDomain) {
  for (std::uint32_t domain = 0; domain <= 232; ++domain) {
    EXPECT_EQ(port_collision(domain, 2368, 8308), std::nullopt) << domain;
  }
}

}  // namespace
}  // namespace convexcut::config
