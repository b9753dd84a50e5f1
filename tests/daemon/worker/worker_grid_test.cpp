// SPDX-License-Identifier: Apache-2.0
//
// How many results the worker gives and when they are due, in simulated time. Does not prove that a
// real host wakes it in time.
#include <gtest/gtest.h>

#include "tests/daemon/worker/simulated_time.hpp"
#include "tests/support/effort.hpp"

namespace convexcut::daemon {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kPeriod = milliseconds{100};
constexpr Duration kLatency = milliseconds{10};

[[nodiscard]] std::size_t count(const std::vector<Taken>& taken, ScanEnd end) {
  return static_cast<std::size_t>(
      std::count_if(taken.begin(), taken.end(), [end](const Taken& t) { return t.end == end; }));
}

void expect_about(std::size_t found, std::size_t expected) {
  EXPECT_GE(found, expected - 1);
  EXPECT_LE(found, expected + 1);
}

// From one due time to the next.
[[nodiscard]] std::pair<Duration, Duration> shortest_and_longest_gap(
    const std::vector<Taken>& taken) {
  Duration shortest = Duration::max();
  Duration longest = Duration::zero();
  for (std::size_t i = 1; i < taken.size(); ++i) {
    shortest = std::min<Duration>(shortest, taken[i].due - taken[i - 1].due);
    longest = std::max<Duration>(longest, taken[i].due - taken[i - 1].due);
  }
  return {shortest, longest};
}

TEST(WorkerGrid, WithoutASensorResultsAreEmptyAndExactlyAPeriodApart) {
  SimulatedWorker sim;
  sim.powered = [](Duration) { return false; };
  sim.run(seconds{60});
  expect_about(sim.taken.size(), 600);
  EXPECT_EQ(count(sim.taken, ScanEnd::no_data), sim.taken.size());
  EXPECT_EQ(shortest_and_longest_gap(sim.taken), std::pair(kPeriod, kPeriod));
  EXPECT_EQ(sim.counters.missed_instants, 0U);
}

// At the contract's speeds: every revolution is a result, due at the latency after its last firing.
class WorkerGridLocked : public ::testing::TestWithParam<double> {};

TEST_P(WorkerGridLocked, GivesEveryRevolutionAtTheConstantLatency) {
  SimulatedWorker sim;
  sim.lidar.rate_hz = GetParam();
  const std::uint64_t length_s = test::repetitions(60);
  sim.run(seconds{length_s});
  expect_about(sim.taken.size(),
               static_cast<std::size_t>(static_cast<double>(length_s) * GetParam()));
  EXPECT_EQ(sim.counters.superseded_scans, 0U);
  EXPECT_LE(sim.counters.empty_results, 1U);
  for (std::size_t i = 2; i < sim.taken.size(); ++i) {
    const Taken& t = sim.taken[i];
    ASSERT_EQ(t.end, ScanEnd::cut) << i;
    EXPECT_EQ(sim.clock.host_at(t.due) - t.last_firing, kLatency) << i;
    EXPECT_LT(t.at, t.due) << i;  // in time for the publisher
    EXPECT_LT(t.at - sim.clock.steady_at(t.last_firing), milliseconds{3}) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, WorkerGridLocked, ::testing::Values(9.0, 9.7, 10.0, 10.3, 11.0));

TEST(WorkerGrid, AFastRotorGivesItsNewestRevolutionTenTimesASecond) {
  SimulatedWorker sim;
  sim.lidar.rate_hz = 20.0;
  sim.run(seconds{60});
  expect_about(sim.taken.size(), 600);
  expect_about(sim.counters.superseded_scans, 600);
  EXPECT_EQ(shortest_and_longest_gap(sim.taken), std::pair(kPeriod, kPeriod));
  for (std::size_t i = 1; i < sim.taken.size(); ++i) {
    ASSERT_EQ(sim.taken[i].end, ScanEnd::cut) << i;
    const Duration age = sim.clock.host_at(sim.taken[i].due) - sim.taken[i].last_firing;
    EXPECT_LE(age, kLatency + milliseconds{51}) << i;
  }
}

TEST(WorkerGrid, ASlowRotorGivesEveryRevolutionAndEmptyResultsBetween) {
  SimulatedWorker sim;
  sim.lidar.rate_hz = 5.0;
  sim.run(seconds{60});
  expect_about(sim.taken.size(), 600);
  expect_about(count(sim.taken, ScanEnd::cut), 300);
  EXPECT_EQ(sim.counters.superseded_scans, 0U);
}

TEST(WorkerGrid, AStandingRotorGivesResultsTenTimesASecond) {
  SimulatedWorker sim;
  sim.lidar.rate_hz = 0.0;
  sim.run(seconds{60});
  expect_about(sim.taken.size(), 600);
  expect_about(count(sim.taken, ScanEnd::timeout), 200);  // the cutter's own, each 300 ms
  EXPECT_EQ(shortest_and_longest_gap(sim.taken), std::pair(kPeriod, kPeriod));
}

TEST(WorkerGrid, ASensorThatGoesAndComesMakesNoDifferenceToTheRate) {
  SimulatedWorker sim;
  sim.lidar.rate_hz = 10.0;
  sim.powered = [](Duration t) { return t < seconds{20} || t > milliseconds{40'030}; };
  sim.run(seconds{60});
  expect_about(sim.taken.size(), 600);
  const auto [shortest, longest] = shortest_and_longest_gap(sim.taken);
  EXPECT_LT(longest, milliseconds{200});
  EXPECT_GT(count(sim.taken, ScanEnd::no_data), 195U);
  EXPECT_LT(count(sim.taken, ScanEnd::no_data), 205U);
  // What there was of the last revolution is not lost.
  expect_about(count(sim.taken, ScanEnd::end_of_input), 1);
}

// The rest of a revolution at the end of a recording waits for the worker's next instant, when the
// end is seen: it was not to be had before.
TEST(WorkerGrid, TheEndOfARecordingMakesNoScanLate) {
  SimulatedWorker sim;
  sim.lidar.rate_hz = 10.0;
  sim.input_ends = milliseconds{5'030};
  sim.run(seconds{60});
  ASSERT_GT(sim.taken.size(), 48U);
  EXPECT_EQ(sim.taken.back().end, ScanEnd::end_of_input);
  EXPECT_GT(sim.taken.back().points, 0U);
  for (const Taken& t : sim.taken) EXPECT_LT(t.at, t.due) << t.index;
  // A whole revolution is due as ever.
  const Taken& whole = sim.taken[sim.taken.size() - 2];
  EXPECT_EQ(whole.end, ScanEnd::cut);
  EXPECT_EQ(sim.clock.host_at(whole.due) - whole.last_firing, kLatency);
}

TEST(WorkerGrid, ChangesOfSpeedNeitherStopNorDoubleResults) {
  SimulatedWorker sim;
  sim.lidar.rate_hz = 10.0;
  sim.lidar.sway_degrees = 120.0;  // 7.9 … 12.1 Hz, once a second
  sim.run(seconds{60});
  const auto [shortest, longest] = shortest_and_longest_gap(sim.taken);
  EXPECT_LE(longest, milliseconds{200});
  EXPECT_GE(sim.taken.size(), 570U);
  EXPECT_LE(sim.taken.size(), 630U);  // between a rate of 9.5 and 10.5
  for (std::size_t i = 1; i < sim.taken.size(); ++i) {
    EXPECT_EQ(sim.taken[i].index, sim.taken[i - 1].index + 1);
    EXPECT_GE(sim.taken[i].due, sim.taken[i - 1].due);
  }
}

TEST(WorkerGrid, PacketsHeldUpMakeTheirScanLateAndNoneLost) {
  SimulatedWorker sim;
  sim.delay = [](Duration sent) {
    const Duration held = milliseconds{5'055} - sent;  // a switch that stops for 40 ms
    return sent > milliseconds{5'015} && held > Duration{0} ? held : Duration{0};
  };
  sim.lidar.start_degrees = 290.0;  // a revolution ends 19.4 ms into each 100 ms
  sim.run(seconds{10});
  expect_about(sim.taken.size(), 100);
  EXPECT_EQ(sim.counters.superseded_scans, 0U);
  std::size_t late = 0;
  for (const Taken& t : sim.taken) late += t.end == ScanEnd::cut && t.at > t.due ? 1U : 0U;
  EXPECT_EQ(late, 1U);
}

TEST(WorkerGrid, AWorkerThatWasHeldUpLeavesOutWhatItMissed) {
  SimulatedWorker sim;
  bool held = false;
  sim.at = [&](Duration t) {
    // Time goes on during a computation of 350 ms.
    if (t > seconds{5} && !std::exchange(held, true)) {
      sim.clock.wait_until(sim.clock.now() + milliseconds{350});
    }
  };
  sim.run(seconds{10});
  EXPECT_GE(sim.counters.missed_instants, 2U);
  expect_about(sim.taken.size() + sim.counters.missed_instants, 100);
  EXPECT_GE(sim.counters.superseded_scans + sim.counters.dropped_scans, 2U);
}

TEST(WorkerGrid, ClockWindowsAreResultsEach) {
  SimulatedWorker sim;
  PipelineOptions options;
  options.fixed_mount = true;
  options.convex_cut.planes = 4;
  options.cut.mode = CutOptions::Mode::clock;
  sim.lidar.rate_hz = 5.0;
  sim.run(seconds{20}, options);
  expect_about(sim.taken.size(), 200);
  EXPECT_LE(sim.counters.superseded_scans, 1U);  // before the grid is locked
  for (std::size_t i = 2; i < sim.taken.size(); ++i) EXPECT_EQ(sim.taken[i].end, ScanEnd::cut) << i;
}

}  // namespace
}  // namespace convexcut::daemon
