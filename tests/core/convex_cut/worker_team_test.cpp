// SPDX-License-Identifier: Apache-2.0
//
// Data races show under ThreadSanitizer only: this test is part of its run.
#include "core/convex_cut/worker_team.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/shared_step.hpp"

namespace convexcut {
namespace {

// Of all members, in turns: the caller returns from its call when every other one has come.
class Visitors {
 public:
  explicit Visitors(unsigned size) : calls_(size, 0), threads_(size) {}
  void operator()(unsigned member) noexcept {
    ++calls_[member];
    threads_[member] = std::this_thread::get_id();
    arrived_.fetch_add(1);
    while (member == 0 && arrived_.load() % calls_.size() != 0) std::this_thread::yield();
  }
  [[nodiscard]] const std::vector<int>& calls() const { return calls_; }
  [[nodiscard]] const std::vector<std::thread::id>& threads() const { return threads_; }

 private:
  std::vector<int> calls_;  // plain: run() orders the accesses
  std::vector<std::thread::id> threads_;
  std::atomic<std::size_t> arrived_{0};
};

TEST(WorkerTeam, CallsEveryMemberThatComesOnceARound) {
  for (const unsigned size : {1U, 2U, 3U, 4U}) {
    WorkerTeam team(size);
    ASSERT_EQ(team.size(), size);
    Visitors work(size);
    for (int round = 1; round <= 200; ++round) {
      team.run(work);
      ASSERT_EQ(work.calls(), std::vector<int>(size, round));
    }
  }
}

TEST(WorkerTeam, WaitsForNobodyWhoHasNotCome) {
  WorkerTeam team(4);
  std::vector<int> calls(4, 0);
  auto work = [&](unsigned member) noexcept { ++calls[member]; };
  for (int round = 1; round <= 2000; ++round) {  // shorter than waking a thread takes
    team.run(work);
    ASSERT_EQ(calls[0], round);
    for (const int of_member : calls) ASSERT_LE(of_member, round);
  }
}

TEST(WorkerTeam, MemberZeroIsTheCallingThread) {
  WorkerTeam team(2);
  Visitors work(2);
  team.run(work);
  EXPECT_EQ(work.threads()[0], std::this_thread::get_id());
  EXPECT_NE(work.threads()[1], std::this_thread::get_id());
}

TEST(WorkerTeam, OfNobodyIsTheCallingThreadAlone) {
  WorkerTeam team(0);
  int calls = 0;
  auto work = [&](unsigned) noexcept { ++calls; };
  team.run(work);
  EXPECT_EQ(team.size(), 1U);
  EXPECT_EQ(calls, 1);
}

TEST(SharedStep, DoesEachItemOnceWhoeverHasItInItsCache) {
  for (const unsigned size : {1U, 2U, 3U}) {
    WorkerTeam team(size);
    for (const std::uint32_t items : {0U, 1U, 7U, 100U}) {
      for (const std::uint32_t of_front : {0U, items / 3, items}) {
        std::vector<int> done(items, 0);  // plain: the step orders the accesses
        SharedStep step;
        SharedStep after;
        step.prepare(items, of_front);
        after.prepare(1);
        int sum = 0;
        auto work = [&](unsigned member) noexcept {
          step.run(member, [&](std::uint32_t item) { ++done[item]; });
          after.run(member, [&](std::uint32_t) {
            for (const int times : done) sum += times == 1 ? 1 : 1000;
          });
        };
        team.run(work);
        ASSERT_EQ(sum, static_cast<int>(items));
      }
    }
  }
}

TEST(SharedStep, DoesNotWaitForSomebodyWhoNeverComes) {
  for (const unsigned member : {0U, 1U}) {
    SharedStep step;
    step.prepare(10, 5);
    int done = 0;
    step.run(member, [&](std::uint32_t) { ++done; });
    EXPECT_EQ(done, 10);
  }
}

TEST(WorkerTeam, StopsWithoutEverHavingWorked) { EXPECT_EQ(WorkerTeam(4).size(), 4U); }

}  // namespace
}  // namespace convexcut
