// SPDX-License-Identifier: Apache-2.0
//
// What is asked of the kernel, and what is said when it refuses. Each case in a process of its own,
// since locked memory and default stacks stay. Does not prove that anything is on time.
#include "daemon/realtime/realtime.hpp"

#include <memory>
#include <thread>

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>

#include <gmock/gmock.h>

#include "config/loader.hpp"
#include "daemon/realtime/allocation_watch.hpp"
#include "tests/support/in_child.hpp"

namespace convexcut::daemon {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

[[nodiscard]] bool fifo_is_permitted() {
  const sched_param one{1};
  if (::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &one) != 0) return false;
  const sched_param normal{0};
  return ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &normal) == 0;
}

struct Scheduled {
  int policy = -1;
  int priority = -1;
  std::string name;
  int cpus = 0;
};

[[nodiscard]] Scheduled of_a_thread(const Realtime& realtime, ThreadRole role) {
  Scheduled found;
  std::thread([&] {
    realtime.enter(role, "a_name");
    sched_param parameters{};
    ::pthread_getschedparam(::pthread_self(), &found.policy, &parameters);
    found.priority = parameters.sched_priority;
    char name[16] = {};
    ::pthread_getname_np(::pthread_self(), name, sizeof name);
    found.name = name;
    cpu_set_t cpus;
    ::sched_getaffinity(0, sizeof cpus, &cpus);
    found.cpus = CPU_COUNT(&cpus);
  }).join();
  return found;
}

TEST(Realtime, ThreadsHaveThePrioritiesOfTheirRoles) {
  test::in_child(fifo_is_permitted, "SCHED_FIFO is not permitted here", [] {
    config::RealtimeSettings settings;
    settings.lock_memory = false;
    settings.worker_cpus = "0";
    const Realtime realtime(settings);
    EXPECT_TRUE(realtime.scheduled());
    EXPECT_THAT(realtime.problems(), IsEmpty());
    const Scheduled worker = of_a_thread(realtime, ThreadRole::worker);
    EXPECT_EQ(worker.policy, SCHED_FIFO);
    EXPECT_EQ(worker.priority, 70);
    EXPECT_EQ(worker.name, "a_name");
    EXPECT_EQ(worker.cpus, 1);
    EXPECT_EQ(of_a_thread(realtime, ThreadRole::receive).priority, 80);
    EXPECT_EQ(of_a_thread(realtime, ThreadRole::publish).priority, 60);
    EXPECT_EQ(of_a_thread(realtime, ThreadRole::transport).priority, 59);
    EXPECT_EQ(of_a_thread(realtime, ThreadRole::other).policy, SCHED_OTHER);
  });
}

TEST(Realtime, WhatIsMadeAsARoleInheritsItAndTheMakerDoesNot) {
  test::in_child(fifo_is_permitted, "SCHED_FIFO is not permitted here", [] {
    config::RealtimeSettings settings;
    settings.lock_memory = false;
    const Realtime realtime(settings);
    const int inherited = realtime.as(ThreadRole::worker, [] {
      int policy = -1;
      std::thread([&policy] {
        sched_param parameters{};
        ::pthread_getschedparam(::pthread_self(), &policy, &parameters);
      }).join();
      return policy;
    });
    EXPECT_EQ(inherited, SCHED_FIFO);
    EXPECT_EQ(::sched_getscheduler(0), SCHED_OTHER);
  });
}

TEST(Realtime, WithoutPermissionItSaysOnceWhatToDoAndGoesOn) {
  test::without_privileges([] {
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_RTPRIO, &none);
    ::setrlimit(RLIMIT_MEMLOCK, &none);
    const Realtime realtime(config::RealtimeSettings{});
    EXPECT_FALSE(realtime.scheduled());
    EXPECT_FALSE(realtime.memory_locked());
    ASSERT_THAT(realtime.problems(), SizeIs(2));
    EXPECT_THAT(realtime.problems()[0], HasSubstr("LimitRTPRIO=80"));
    EXPECT_THAT(realtime.problems()[1], HasSubstr("LimitMEMLOCK=infinity"));
    EXPECT_EQ(of_a_thread(realtime, ThreadRole::worker).policy, SCHED_OTHER);
  });
}

// A limit that today's memory fits and tomorrow's does not would make later allocations fail.
TEST(Realtime, ALimitThatIsTooLowForLaterLocksNothing) {
  test::without_privileges([] {
    const rlimit low{rlim_t{128} << 20U, rlim_t{128} << 20U};
    if (::setrlimit(RLIMIT_MEMLOCK, &low) != 0) return;  // the hard limit is lower still
    const Realtime realtime(config::RealtimeSettings{});
    EXPECT_FALSE(realtime.memory_locked());
  });
}

TEST(Realtime, WhereItIsDemandedARefusalStopsTheStart) {
  test::without_privileges([] {
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_RTPRIO, &none);
    config::RealtimeSettings settings;
    settings.enabled = config::Realtime::on;
    try {
      const Realtime realtime(settings);
      ADD_FAILURE() << "started";
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr("realtime.enabled is \"on\""));
    }
  });
}

// Where memory is not locked, what is made before the threads start has its pages then.
TEST(Realtime, PopulatesTheHeap) {
  if (!allocations_are_heard()) GTEST_SKIP() << "a sanitizer has its own allocator";
  test::in_child([] { return true; }, "",
                 [] {
                   config::RealtimeSettings settings;
                   settings.lock_memory = false;
                   const Realtime realtime(settings);
                   constexpr std::size_t kBytes = std::size_t{8} << 20U;
                   const auto memory = std::unique_ptr<char[]>(new char[kBytes]);
                   realtime.populate_memory();
                   const auto faults = [] {
                     rusage usage{};
                     ::getrusage(RUSAGE_THREAD, &usage);
                     return usage.ru_minflt;
                   };
                   const long before = faults();
                   for (std::size_t at = 0; at < kBytes; at += 4096) {
                     static_cast<volatile char*>(memory.get())[at] = 1;
                   }
                   EXPECT_LT(faults() - before, 16);
                 });
}

TEST(Realtime, OffAsksForNothing) {
  config::RealtimeSettings settings;
  settings.enabled = config::Realtime::off;
  const Realtime realtime(settings);
  EXPECT_FALSE(realtime.scheduled());
  EXPECT_FALSE(realtime.memory_locked());
  EXPECT_THAT(realtime.problems(), IsEmpty());
  EXPECT_EQ(of_a_thread(realtime, ThreadRole::worker).policy, SCHED_OTHER);
}

TEST(Realtime, CpusThatAreNotThereAreWrongConfiguration) {
  config::RealtimeSettings settings;
  settings.enabled = config::Realtime::off;
  settings.worker_cpus = "1023";
  try {
    const Realtime realtime(settings);
    ADD_FAILURE() << "started";
  } catch (const config::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("realtime.worker_cpus"));
  }
}

}  // namespace
}  // namespace convexcut::daemon
