// SPDX-License-Identifier: Apache-2.0
//
// Data races show under ThreadSanitizer only: this test is part of its run.
#include "core/convex_cut/worker_team.hpp"

#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace convexcut {
namespace {

TEST(WorkerTeam, CallsEveryMemberOnceARound) {
  for (const unsigned size : {1U, 2U, 3U, 4U}) {
    WorkerTeam team(size);
    ASSERT_EQ(team.size(), size);
    std::vector<int> calls(size, 0);  // plain: run() orders the accesses
    auto work = [&](unsigned member) noexcept { ++calls[member]; };
    for (int round = 1; round <= 200; ++round) {
      team.run(work);
      ASSERT_EQ(calls, std::vector<int>(size, round));
    }
  }
}

TEST(WorkerTeam, MemberZeroIsTheCallingThread) {
  WorkerTeam team(2);
  std::vector<std::thread::id> threads(2);
  auto work = [&](unsigned member) noexcept { threads[member] = std::this_thread::get_id(); };
  team.run(work);
  EXPECT_EQ(threads[0], std::this_thread::get_id());
  EXPECT_NE(threads[1], std::this_thread::get_id());
}

TEST(WorkerTeam, OfNobodyIsTheCallingThreadAlone) {
  WorkerTeam team(0);
  int calls = 0;
  auto work = [&](unsigned) noexcept { ++calls; };
  team.run(work);
  EXPECT_EQ(team.size(), 1U);
  EXPECT_EQ(calls, 1);
}

TEST(WorkerTeam, StopsWithoutEverHavingWorked) { EXPECT_EQ(WorkerTeam(4).size(), 4U); }

}  // namespace
}  // namespace convexcut
