// SPDX-License-Identifier: Apache-2.0
//
// When less, and when more again, is computed. Does not prove that less work takes less time.
#include "daemon/effort_policy.hpp"

#include <utility>

#include <gtest/gtest.h>

namespace convexcut::daemon {
namespace {

using std::chrono::milliseconds;

constexpr Duration kBudget = milliseconds{10};
constexpr Duration kOver = milliseconds{11};
constexpr Duration kCalm = milliseconds{5};
constexpr Duration kBusy = milliseconds{8};

void observe(EffortPolicy& policy, Duration used, std::uint32_t scans) {
  for (std::uint32_t i = 0; i < scans; ++i) policy.observe({.used = used, .budget = kBudget});
}

TEST(EffortPolicy, OneOverrunChangesNothing) {
  EffortPolicy policy;
  for (int i = 0; i < 100; ++i) {
    policy.observe({.used = kOver, .budget = kBudget});
    policy.observe({.used = kBusy, .budget = kBudget});
  }
  EXPECT_EQ(policy.effort(), Effort::full);
}

TEST(EffortPolicy, TakingExactlyTheBudgetIsNoOverrun) {
  EffortPolicy policy;
  observe(policy, kBudget, 100);
  EXPECT_EQ(policy.effort(), Effort::full);
}

TEST(EffortPolicy, OverrunsInARowReduceInTheStatedOrderAndStopAtTheLeast) {
  EffortPolicy policy;
  for (const Effort expected : {Effort::half_planes, Effort::quarter_planes, Effort::half_points,
                                Effort::half_points, Effort::half_points}) {
    observe(policy, kOver, EffortPolicy::kOverruns);
    EXPECT_EQ(policy.effort(), expected);
  }
}

TEST(EffortPolicy, ACalmTimeRestoresOneStepEach) {
  EffortPolicy policy;
  observe(policy, kOver, 3 * EffortPolicy::kOverruns);
  ASSERT_EQ(policy.effort(), Effort::half_points);
  for (const Effort expected : {Effort::quarter_planes, Effort::half_planes, Effort::full}) {
    const Effort before = policy.effort();
    observe(policy, kCalm, EffortPolicy::kShortestCalm - 1);
    EXPECT_EQ(policy.effort(), before);
    observe(policy, kCalm, 1);
    EXPECT_EQ(policy.effort(), expected);
  }
  observe(policy, kCalm, 1'000);
  EXPECT_EQ(policy.effort(), Effort::full);
}

TEST(EffortPolicy, BetweenCalmAndOverrunNothingChanges) {
  EffortPolicy policy;
  observe(policy, kOver, EffortPolicy::kOverruns);
  observe(policy, kBusy, 10'000);
  EXPECT_EQ(policy.effort(), Effort::half_planes);
}

// What takes 11 of 10 ms in full and 5 with half the planes: tried again ever more rarely.
TEST(EffortPolicy, ALoadThatStaysIsTriedEverMoreRarely) {
  EffortPolicy policy;
  std::uint32_t late = 0;
  for (int scan = 0; scan < 36'000; ++scan) {  // an hour
    const bool full = policy.effort() == Effort::full;
    late += full ? 1U : 0U;
    policy.observe({.used = full ? kOver : kCalm, .budget = kBudget});
  }
  EXPECT_LT(late, 140U);  // kOverruns a try, a try in 64 s
  EXPECT_GE(late, 100U);
}

TEST(EffortPolicy, ALoadThatComesMuchLaterIsNoFailedStepUp) {
  EffortPolicy policy;
  observe(policy, kOver, EffortPolicy::kOverruns);
  observe(policy, kCalm, EffortPolicy::kShortestCalm);
  ASSERT_EQ(policy.effort(), Effort::full);
  observe(policy, kCalm, 10 * EffortPolicy::kShortestCalm);
  observe(policy, kOver, EffortPolicy::kOverruns);
  observe(policy, kCalm, EffortPolicy::kShortestCalm);
  EXPECT_EQ(policy.effort(), Effort::full);
}

// Labels that would wait for 20 ms of learning again are no step up, calm as they are without.
TEST(EffortPolicy, LabelsWaitForLearningOnlyWhereThereIsTimeForBoth) {
  for (const auto& [budget, expected] :
       {std::pair{milliseconds{10}, Effort::half_planes}, {milliseconds{60}, Effort::full}}) {
    EffortPolicy policy;
    observe(policy, milliseconds{100}, EffortPolicy::kOverruns);
    ASSERT_EQ(policy.effort(), Effort::half_planes);
    for (std::uint32_t i = 0; i < EffortPolicy::kShortestCalm; ++i) {
      policy.observe({.used = milliseconds{4},
                      .budget = budget,
                      .learning = milliseconds{20},
                      .period = milliseconds{100},
                      .learns_first = true});
    }
    EXPECT_EQ(policy.effort(), expected);
  }
}

// Labels are in time, but with what is learnt after each of them the next scan is not begun in
// time.
TEST(EffortPolicy, LearnsMoreRarelyWhatThePeriodHasNoTimeFor) {
  EffortPolicy policy;
  for (int i = 0; i < 10'000; ++i) {
    policy.observe({.used = milliseconds{4},
                    .budget = kBudget,
                    .learning = milliseconds{97},
                    .period = milliseconds{100}});
    EXPECT_LE(policy.effort(), Effort::half_planes);
  }
  EXPECT_EQ(policy.effort(), Effort::half_planes);
}

TEST(EffortPolicy, TheBudgetOfEachScanIsItsOwn) {
  EffortPolicy policy;
  policy.observe({.used = milliseconds{5}, .budget = milliseconds{4}});
  policy.observe({.used = milliseconds{5}, .budget = milliseconds{4}});
  EXPECT_EQ(policy.effort(), Effort::half_planes);
}

}  // namespace
}  // namespace convexcut::daemon
