// SPDX-License-Identifier: Apache-2.0
//
// The pipeline as a whole, on synthetic batches and samples. Does not prove that its parts are
// right by themselves (they have their own tests), nor anything about threads.
#include "daemon/pipeline/pipeline.hpp"

#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/scan/synthetic_lidar.hpp"

namespace convexcut::daemon {
namespace {

using std::chrono::milliseconds;
using test::SyntheticLidar;

// The lidar's counter in the middle of an hour, so that arrivals around it unwrap to it.
constexpr std::uint32_t kCountAtStart = 1'000'000'000;
constexpr HostTime kStart = from_ns<HostTime>(1'700'000'000'000'000'000);

PipelineOptions fixed_mount() {
  PipelineOptions options;
  options.fixed_mount = true;
  return options;
}

PipelineOptions imu_mount() { return PipelineOptions{}; }

// Plays an ideal lidar whose datagrams arrive when their last firing is over, and an IMU.
class Player {
 public:
  explicit Player(const PipelineOptions& options) : pipeline(options) {
    lidar.start = LidarTime{};
    lidar.returns_per_firing = 4;
    reserve(scan, Pipeline::kMaxReturnsPerScan);
  }

  [[nodiscard]] HostTime arrival(std::int64_t packet) const {
    return kStart + (lidar.time(packet + 1) - LidarTime{});
  }
  void send_packet(std::int64_t number, PpsState pps = PpsState::unknown) {
    test::TimedBatch timed = lidar.packet(number);
    const auto elapsed_us = (lidar.time(number) - LidarTime{}).count() / 1000;
    timed.batch.first_firing = {
        static_cast<std::uint32_t>((kCountAtStart + elapsed_us) % 3'600'000'000)};
    timed.batch.arrival = arrival(number) + arrival_delay;
    timed.batch.pps = pps;
    pipeline.on_lidar(timed.batch);
  }
  void send_packets(std::int64_t first, std::int64_t last) {
    for (std::int64_t i = first; i < last; ++i) send_packet(i);
  }
  void send_orientation(Duration after_start, const Quaternion& q = Quaternion::Identity()) {
    ImuSample sample;
    sample.arrival = kStart + after_start;
    sample.has_orientation = true;
    sample.q_level_from_imu = q;
    pipeline.on_imu(sample);
  }
  void send_orientations(Duration from, Duration to) {
    for (Duration t = from; t <= to; t += milliseconds{10}) send_orientation(t);
  }
  void send_angle(Duration after_start, Degrees angle) {
    pipeline.on_encoder({.arrival = kStart + after_start, .angle = angle.to_radians()});
  }
  std::vector<LevelledScan> take(HostTime now) {
    std::vector<LevelledScan> scans;
    while (pipeline.next_scan(now, scan)) scans.push_back(scan);
    return scans;
  }

  SyntheticLidar lidar;
  Duration arrival_delay{0};
  Pipeline pipeline;
  LevelledScan scan;
};

TEST(Pipeline, AFixedMountGivesAScanARevolution) {
  Player player(fixed_mount());
  player.send_packets(0, player.lidar.packets_in(milliseconds{350}));
  EXPECT_EQ(player.take(kStart).size(), 3U);
  player.pipeline.end_of_lidar();
  const auto last = player.take(kStart);
  ASSERT_EQ(last.size(), 1U);
  EXPECT_EQ(last[0].end, ScanEnd::end_of_input);
  EXPECT_NEAR(last[0].coverage, 0.5, 0.02);
}

TEST(Pipeline, EndingTwiceGivesNothingMore) {
  Player player(fixed_mount());
  player.send_packets(0, 50);
  player.pipeline.end_of_lidar();
  player.pipeline.end_of_lidar();
  EXPECT_EQ(player.take(kStart).size(), 1U);
}

TEST(Pipeline, StampsAreFirstFiringsAndScansDoNotOverlap) {
  Player player(fixed_mount());
  HostTime end_of_previous = HostTime::min();
  for (std::int64_t i = 0; i < player.lidar.packets_in(std::chrono::seconds{2}); ++i) {
    player.send_packet(i);
    for (const LevelledScan& scan : player.take(kStart)) {
      EXPECT_GT(scan.stamp, end_of_previous);
      EXPECT_GE(scan.last_firing, scan.stamp);
      end_of_previous = scan.stamp + Duration{scan.time_ns.back()};
      EXPECT_GE(end_of_previous, scan.last_firing);
    }
  }
  EXPECT_GT(end_of_previous, kStart);
}

TEST(Pipeline, AFixedMountTurnsThePoints) {
  PipelineOptions options = fixed_mount();
  options.q_level_from_lidar = to_quaternion({Degrees{0}, Degrees{0}, Degrees{90}});
  Player player(options);
  player.send_packets(0, player.lidar.packets_in(milliseconds{150}));
  const auto scans = player.take(kStart);
  ASSERT_EQ(scans.size(), 1U);
  // The synthetic return i of firing k lies at (k, i, 0): 90° of yaw take it to (−i, k, 0).
  EXPECT_NEAR(scans[0].x[7], -3.0F, 1e-4F);
  EXPECT_NEAR(scans[0].y[7], 1.0F, 1e-4F);
}

TEST(Pipeline, AScanWaitsForTheOrientationOfItsLastFiring) {
  Player player(imu_mount());
  player.send_orientations(milliseconds{-10}, milliseconds{90});
  player.send_packets(0, player.lidar.packets_in(milliseconds{102}));
  EXPECT_TRUE(player.take(kStart + milliseconds{102}).empty());
  player.send_orientation(milliseconds{100});
  const auto scans = player.take(kStart + milliseconds{103});
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans[0].dropped_no_orientation, 0U);
}

TEST(Pipeline, AnOrientationThatDoesNotComeIsWaitedForOnlySoLong) {
  PipelineOptions options = imu_mount();
  options.orientation_wait = milliseconds{5};
  Player player(options);
  player.send_orientations(Duration{0}, milliseconds{40});
  player.send_packets(0, player.lidar.packets_in(milliseconds{102}));
  EXPECT_TRUE(player.take(kStart + milliseconds{104}).empty());
  const auto scans = player.take(kStart + milliseconds{106});
  ASSERT_EQ(scans.size(), 1U);
  // From 90 ms on, the newest orientation is more than 50 ms old: a tenth of the points.
  const double all = static_cast<double>(scans[0].size() + scans[0].dropped_no_orientation);
  EXPECT_NEAR(scans[0].dropped_no_orientation / all, 0.1, 0.01);
  EXPECT_GT(scans[0].size(), 0U);
}

TEST(Pipeline, WithoutAnyOrientationAllPointsAreDroppedAndCounted) {
  Player player(imu_mount());
  player.send_packets(0, player.lidar.packets_in(milliseconds{102}));
  player.pipeline.end_of_imu();
  const auto scans = player.take(kStart);
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans[0].size(), 0U);
  EXPECT_EQ(scans[0].dropped_no_orientation, 2171U * 4U);
}

TEST(Pipeline, EachFiringIsLevelledByTheOrientationAtItsTime) {
  Player player(imu_mount());
  // 90° of yaw within the revolution.
  player.send_orientation(Duration{0});
  for (int ms = 10; ms <= 110; ms += 10) {
    player.send_orientation(milliseconds{ms},
                            to_quaternion({Degrees{0}, Degrees{0}, Degrees{0.9 * ms}}));
  }
  player.send_packets(0, player.lidar.packets_in(milliseconds{110}));
  const auto scans = player.take(kStart + milliseconds{110});
  ASSERT_EQ(scans.size(), 1U);
  const std::size_t middle = scans[0].size() / 2;  // ring 0 of a firing at about 50 ms
  const double x = static_cast<double>(scans[0].x[middle]);
  const double y = static_cast<double>(scans[0].y[middle]);
  EXPECT_NEAR(std::atan2(y, x) * 180.0 / 3.14159265, 45.0, 0.2);
}

// The return of the synthetic lidar's firing 7 and ring 1 lies at (7, 1, 0).
constexpr std::size_t kFiring7Ring1 = 7 * 4 + 1;

void expect_at(const LevelledScan& scan, std::size_t i, const Vec3& p_level) {
  EXPECT_NEAR(scan.x[i], p_level.x(), 1e-4);
  EXPECT_NEAR(scan.y[i], p_level.y(), 1e-4);
  EXPECT_NEAR(scan.z[i], p_level.z(), 1e-4);
}

TEST(Pipeline, AStageTurnsTheLidarOnItsFixedMount) {
  for (const StageAxis axis : {StageAxis::rotation, StageAxis::tilt}) {
    PipelineOptions options = fixed_mount();
    options.q_level_from_lidar = to_quaternion({Degrees{10}, Degrees{20}, Degrees{90}});
    options.stage_use = StageUse::orientation;
    options.stage_axis = axis;
    Player player(options);
    for (int ms = -10; ms <= 110; ms += 10) player.send_angle(milliseconds{ms}, Degrees{40});
    player.send_packets(0, player.lidar.packets_in(milliseconds{102}));
    const auto scans = player.take(kStart + milliseconds{102});
    ASSERT_EQ(scans.size(), 1U);
    const Quaternion stage = stage_rotation(axis, Degrees{40}.to_radians());
    expect_at(scans[0], kFiring7Ring1, options.q_level_from_lidar * (stage * Vec3(7, 1, 0)));
    EXPECT_EQ(player.pipeline.stage_angles(), 13U);
  }
}

TEST(Pipeline, AStageGivesTheHeadingAndTheImuTheRest) {
  PipelineOptions options = imu_mount();
  options.stage_use = StageUse::heading;
  Player player(options);
  for (int ms = -10; ms <= 110; ms += 10) {
    // The IMU's heading drifts away; that of the stage stands still.
    player.send_orientation(milliseconds{ms},
                            to_quaternion({Degrees{5}, Degrees{-8}, Degrees{0.3 * ms}}));
    player.send_angle(milliseconds{ms}, Degrees{-60});
  }
  player.send_packets(0, player.lidar.packets_in(milliseconds{102}));
  const auto scans = player.take(kStart + milliseconds{102});
  ASSERT_EQ(scans.size(), 1U);
  const Quaternion q = to_quaternion({Degrees{5}, Degrees{-8}, Degrees{-60}});
  expect_at(scans[0], kFiring7Ring1, q * Vec3(7, 1, 0));
  const std::size_t late = 4 * 2000 + 2;  // of firing 2000, at 92 ms
  expect_at(scans[0], late, q * Vec3(2000, 2, 0));
}

TEST(Pipeline, EachFiringIsTurnedByTheStagesAngleAtItsTime) {
  PipelineOptions options = fixed_mount();
  options.stage_use = StageUse::orientation;
  Player player(options);
  for (int ms = -10; ms <= 110; ms += 10) player.send_angle(milliseconds{ms}, Degrees{0.9 * ms});
  player.send_packets(0, player.lidar.packets_in(milliseconds{102}));
  const auto scans = player.take(kStart + milliseconds{102});
  ASSERT_EQ(scans.size(), 1U);
  const std::size_t i = 4 * 1000;  // ring 0 of firing 1000, on the x axis
  const double degrees =
      std::atan2(static_cast<double>(scans[0].y[i]), static_cast<double>(scans[0].x[i])) * 180.0 /
      3.14159265;
  EXPECT_NEAR(degrees, 0.9 * 46.08, 0.05);
}

TEST(Pipeline, AScanWaitsForTheStagesAngleAndNotForEver) {
  PipelineOptions options = fixed_mount();
  options.stage_use = StageUse::orientation;
  options.stage_max_age = milliseconds{20};
  options.orientation_wait = milliseconds{5};
  Player player(options);
  for (int ms = 0; ms <= 70; ms += 10) player.send_angle(milliseconds{ms}, Degrees{1});
  player.send_packets(0, player.lidar.packets_in(milliseconds{102}));
  EXPECT_TRUE(player.take(kStart + milliseconds{104}).empty());
  const auto scans = player.take(kStart + milliseconds{106});
  ASSERT_EQ(scans.size(), 1U);
  // From 90 ms on the newest angle is older than its timeout: a tenth of the points.
  const double all = static_cast<double>(scans[0].size() + scans[0].dropped_no_orientation);
  EXPECT_NEAR(scans[0].dropped_no_orientation / all, 0.1, 0.01);
}

TEST(Pipeline, NoMoreAnglesMeansNoMoreWaiting) {
  PipelineOptions options = fixed_mount();
  options.stage_use = StageUse::orientation;
  Player player(options);
  player.send_packets(0, player.lidar.packets_in(milliseconds{102}));
  EXPECT_TRUE(player.take(kStart + milliseconds{102}).empty());
  player.pipeline.end_of_encoder();
  const auto scans = player.take(kStart + milliseconds{102});
  ASSERT_EQ(scans.size(), 1U);
  EXPECT_EQ(scans[0].size(), 0U);
}

TEST(Pipeline, AnglesAreTakenAgainAfterTheHostsClockWasSetBack) {
  PipelineOptions options = fixed_mount();
  options.stage_use = StageUse::orientation;
  Player player(options);
  player.send_angle(std::chrono::hours{1}, Degrees{1});
  player.send_angle(milliseconds{0}, Degrees{1});
  player.send_angle(milliseconds{10}, Degrees{1});
  player.send_angle(milliseconds{5}, Degrees{1});  // out of order by little: refused
  EXPECT_EQ(player.pipeline.stage_angles(), 3U);
  EXPECT_EQ(player.pipeline.stage_angles_refused(), 1U);
}

TEST(Pipeline, AnglesThatAreNotUsedChangeNothing) {
  Player player(fixed_mount());
  player.send_angle(milliseconds{0}, Degrees{45});
  player.send_packets(0, player.lidar.packets_in(milliseconds{102}));
  const auto scans = player.take(kStart);
  ASSERT_EQ(scans.size(), 1U);
  expect_at(scans[0], kFiring7Ring1, Vec3(7, 1, 0));
}

// How many of nine scans are learnt from after their labels. The first one's have nothing else to
// come from than itself.
int learnt_after(const PipelineOptions& options, Effort effort) {
  Player player(options);
  player.pipeline.set_effort(effort);
  int scans = 0;
  int learnt = 0;
  for (std::int64_t packet = 0; scans < 9; ++packet) {
    player.send_packet(packet);
    if (!player.pipeline.level_next(player.arrival(packet), player.scan)) continue;
    player.pipeline.cut(player.scan);
    ++scans;
    learnt += player.pipeline.learn() ? 1 : 0;
  }
  return learnt;
}

TEST(Pipeline, WithLessEffortTheRobustMethodLearnsFromFewerScans) {
  PipelineOptions options = fixed_mount();
  options.method = config::Method::robust;
  options.learn_first = false;
  EXPECT_EQ(learnt_after(options, Effort::full), 8);
  EXPECT_EQ(learnt_after(options, Effort::half_planes), 4);
  EXPECT_EQ(learnt_after(options, Effort::quarter_planes), 2);
  EXPECT_EQ(learnt_after(options, Effort::half_points), 2);
}

TEST(Pipeline, LabelsThatWaitForWhatIsLearntNoLongerDoWithLessEffort) {
  PipelineOptions options = fixed_mount();
  options.method = config::Method::robust;
  EXPECT_EQ(learnt_after(options, Effort::full), 0);
  EXPECT_EQ(learnt_after(options, Effort::half_planes), 4);
}

TEST(Pipeline, ThePapersMethodLearnsNothing) {
  Player player(fixed_mount());
  player.send_packets(0, 400);
  player.pipeline.end_of_lidar();
  EXPECT_FALSE(player.take(player.arrival(400)).empty());
  EXPECT_FALSE(player.pipeline.learn());
}

TEST(Pipeline, ScansThatNobodyTakesAreDroppedAndCounted) {
  Player player(fixed_mount());
  player.send_packets(0, player.lidar.packets_in(milliseconds{705}));
  EXPECT_EQ(player.pipeline.waiting(), Pipeline::kMaxWaiting);
  EXPECT_EQ(player.pipeline.scans_cut(), 7U);
  EXPECT_EQ(player.pipeline.scans_dropped(), 3U);
  EXPECT_EQ(player.take(kStart).size(), Pipeline::kMaxWaiting);
}

// The host's time at which the lidar's counter would be UTC: kStart is 22:13:20 UTC, 800 s past the
// hour.
constexpr std::uint32_t kUtcCountAtStart = 800'000'000;

std::optional<Duration> stamp_error_with_pps(PpsState pps, Duration host_ahead) {
  Player player(fixed_mount());
  for (std::int64_t i = 0; i < player.lidar.packets_in(milliseconds{102}); ++i) {
    test::TimedBatch timed = player.lidar.packet(i);
    const auto elapsed_us = (player.lidar.time(i) - LidarTime{}).count() / 1000;
    timed.batch.first_firing = {static_cast<std::uint32_t>(kUtcCountAtStart + elapsed_us)};
    timed.batch.arrival = player.arrival(i) + milliseconds{2} + host_ahead;
    timed.batch.pps = pps;
    player.pipeline.on_lidar(timed.batch);
  }
  const auto scans = player.take(kStart);
  if (scans.size() != 1) return std::nullopt;
  return scans[0].stamp - kStart;
}

TEST(LidarTimeSource, ALockedPpsGivesTheSensorsOwnUtc) {
  EXPECT_EQ(stamp_error_with_pps(PpsState::locked, Duration{0}), Duration{0});
}

TEST(LidarTimeSource, WithoutAPpsTheArrivalDelayRemains) {
  for (const PpsState pps :
       {PpsState::unknown, PpsState::absent, PpsState::synchronising, PpsState::error}) {
    const auto error = stamp_error_with_pps(pps, Duration{0});
    ASSERT_TRUE(error);
    EXPECT_NEAR(static_cast<double>(error->count()), 2e6, 2e4);
  }
}

TEST(LidarTimeSource, APpsAtOddsWithTheHostsClockIsNotBelieved) {
  const auto error = stamp_error_with_pps(PpsState::locked, std::chrono::seconds{17});
  ASSERT_TRUE(error);
  EXPECT_NEAR(static_cast<double>(error->count()), 17.002e9, 1e6);
}

}  // namespace
}  // namespace convexcut::daemon
