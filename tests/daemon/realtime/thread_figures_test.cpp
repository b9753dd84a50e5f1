// SPDX-License-Identifier: Apache-2.0
//
// What is known of each thread. Does not prove that the daemon's threads behave: tests/soak.sh
// reads these figures of the daemon itself.
#include "daemon/realtime/thread_figures.hpp"

#include <memory>
#include <string>
#include <thread>

#include <sys/mman.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "daemon/realtime/allocation_watch.hpp"

namespace convexcut::daemon {
namespace {

TEST(ThreadUsage, ReadsTheFieldsOfProc) {
  const auto usage = parse_thread_usage(
      "77 (a) b (c)) S 1 2 3 4 5 6 1234 8 56 9 250 50 11 12 20 0 1 0 99 1000 100", 100);
  ASSERT_TRUE(usage);
  EXPECT_EQ(usage->minor_faults, 1234U);
  EXPECT_EQ(usage->major_faults, 56U);
  EXPECT_EQ(usage->cpu_time, std::chrono::seconds{3});
}

TEST(ThreadUsage, RefusesWhatIsNoSuchText) {
  for (const char* bad :
       {"", "77", "77 (name)", "77 (name) S 1 2 3", "77 (n) S 1 2 3 4 5 6 x 8 9"}) {
    EXPECT_FALSE(parse_thread_usage(bad, 100)) << bad;
  }
  EXPECT_FALSE(thread_usage(-1));
}

TEST(ThreadUsage, CountsTheFaultsOfThisThread) {
  constexpr std::size_t kBytes = 64 * 4096;
  const auto before = thread_usage(::gettid());
  void* const memory =
      ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  ::madvise(memory, kBytes, MADV_NOHUGEPAGE);
  for (std::size_t at = 0; at < kBytes; at += 4096) static_cast<volatile char*>(memory)[at] = 1;
  const auto after = thread_usage(::gettid());
  ::munmap(memory, kBytes);
  ASSERT_TRUE(before && after);
  EXPECT_GE(after->minor_faults, before->minor_faults + 64);
}

class AllocationWatch : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!allocations_are_heard()) GTEST_SKIP() << "a sanitizer has its own allocator";
  }
};

TEST_F(AllocationWatch, HearsNewAndDeleteAndTheirRelatives) {
  Counter calls;
  watch_allocations(&calls);
  auto number = std::make_unique<int>(1);
  number.reset();
  EXPECT_EQ(calls.value(), 2U);
  struct alignas(64) Line {
    char bytes[64];
  };
  auto line = std::make_unique<Line>();
  line.reset();
  void* memory = nullptr;
  EXPECT_EQ(::posix_memalign(&memory, 64, 64), 0);
  ::free(memory);
  memory = ::realloc(::calloc(1, 10), 20);
  ::free(memory);
  watch_allocations(nullptr);
  EXPECT_EQ(calls.value(), 9U);
  EXPECT_EQ(::posix_memalign(&memory, 3, 64), 22);
}

TEST_F(AllocationWatch, HearsOnlyTheThreadThatAsksAndOnlyWhileItDoes) {
  Counter calls;
  watch_allocations(&calls);
  watch_allocations(nullptr);
  std::thread other([] { std::make_unique<int>(1).reset(); });
  other.join();
  EXPECT_EQ(calls.value(), 0U);
}

TEST_F(AllocationWatch, ARegisterTellsWhatEachThreadDidSinceItWasSteady) {
  ThreadRegister threads;
  std::atomic<int> step{0};
  std::thread worker([&] {
    threads.enter("worker", ThreadRole::worker);
    std::make_unique<int>(1).reset();  // start-up
    step = 1;
    while (step < 2) std::this_thread::yield();
    std::make_unique<int>(1).reset();
    step = 3;
    while (step < 4) std::this_thread::yield();
    ThreadRegister::leave();
    std::make_unique<int>(1).reset();
  });
  while (step < 1) std::this_thread::yield();
  threads.mark_steady();
  step = 2;
  while (step < 3) std::this_thread::yield();
  const auto figures = threads.figures();
  step = 4;
  worker.join();
  ASSERT_EQ(figures.size(), 1U);
  EXPECT_EQ(figures[0].name, "worker");
  EXPECT_EQ(figures[0].role, ThreadRole::worker);
  EXPECT_EQ(figures[0].allocations, 2U);
  EXPECT_EQ(figures[0].major_faults, 0U);
  EXPECT_EQ(threads.figures()[0].allocations, 2U);  // of a thread that has ended as well
}

TEST(ThreadRegister, TakesNoMoreThreadsThanItHasRoomFor) {
  ThreadRegister threads;
  for (std::size_t i = 0; i < ThreadRegister::kMaxThreads + 4; ++i) {
    std::thread([&] {
      threads.enter("thread", ThreadRole::other);
      ThreadRegister::leave();
    }).join();
  }
  EXPECT_EQ(threads.figures().size(), ThreadRegister::kMaxThreads);
}

}  // namespace
}  // namespace convexcut::daemon
