// SPDX-License-Identifier: Apache-2.0
//
// The host's clock is set while the worker runs, in simulated time. Does not prove that the kernel
// stamps as it should.
#include <gtest/gtest.h>

#include "tests/daemon/worker/simulated_time.hpp"

namespace convexcut::daemon {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;

class WorkerClockStep : public ::testing::TestWithParam<Duration> {};

TEST_P(WorkerClockStep, ScansGoOnWithinTwoSecondsInTheNewTime) {
  const Duration step = GetParam();
  SimulatedWorker sim;
  bool set = false;
  sim.at = [&](Duration t) {
    if (t > milliseconds{10'033} && !std::exchange(set, true)) sim.clock.set_by(step);
  };
  sim.run(seconds{20});

  EXPECT_EQ(sim.counters.clock_steps, 1U);
  EXPECT_GT(sim.counters.dropped_by_clock_step, 0U);
  EXPECT_GE(sim.taken.size(), 198U);
  EXPECT_LE(sim.taken.size(), 202U);
  const auto begin = sim.clock.steady_now() - seconds{20};
  for (std::size_t i = 1; i < sim.taken.size(); ++i) {
    const Taken& t = sim.taken[i];
    // The grid is one of CLOCK_MONOTONIC: no result waits for the new time.
    EXPECT_GT(t.due, sim.taken[i - 1].due) << i;
    EXPECT_LT(t.due - sim.taken[i - 1].due, milliseconds{201}) << i;
    if (t.at < begin + seconds{12} || t.end == ScanEnd::no_data) continue;
    // Two seconds after: in the new time, at the constant latency.
    EXPECT_EQ(t.end, ScanEnd::cut) << i;
    EXPECT_EQ(sim.clock.host_at(t.due) - t.last_firing, milliseconds{10}) << i;
    EXPECT_LT(t.at, t.due) << i;
  }
  EXPECT_EQ(sim.taken.back().end, ScanEnd::cut);
  EXPECT_GT(sim.taken.back().points, 2'000U);
}

INSTANTIATE_TEST_SUITE_P(Steps, WorkerClockStep,
                         ::testing::Values(Duration{hours{1}}, Duration{hours{-1}},
                                           Duration{seconds{1}}, Duration{seconds{-1}},
                                           Duration{milliseconds{200}},
                                           Duration{milliseconds{-200}}, Duration{hours{500'000}}));

TEST(WorkerClock, WithoutAStepNothingIsDropped) {
  SimulatedWorker sim;
  sim.run(seconds{5});
  EXPECT_EQ(sim.counters.clock_steps, 0U);
  EXPECT_EQ(sim.counters.dropped_by_clock_step, 0U);
  EXPECT_EQ(sim.counters.dropped_scans, 0U);
}

}  // namespace
}  // namespace convexcut::daemon
