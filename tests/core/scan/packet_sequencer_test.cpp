// SPDX-License-Identifier: Apache-2.0
//
// Order, loss and repetition of datagrams as the sensor's clock tells them. Does not prove that the
// network delivers what it is handed.
#include "core/scan/packet_sequencer.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/scan/synthetic_lidar.hpp"

namespace convexcut {
namespace {

using namespace std::chrono_literals;
using test::SyntheticLidar;
using test::TimedBatch;
using testing::ElementsAre;

// Notes the number of each datagram passed on, from the marks that SyntheticLidar leaves in it.
class Sequencing {
 public:
  explicit Sequencing(std::size_t window = 4) : sequencer(window) { lidar.returns_per_firing = 1; }
  void push(std::int64_t packet) {
    const TimedBatch timed = lidar.packet(packet);
    sequencer.push(timed.batch, timed.first_firing, note_);
  }
  void push(const std::vector<std::int64_t>& packets) {
    for (const std::int64_t packet : packets) push(packet);
  }
  void flush() { sequencer.flush(note_); }

  SyntheticLidar lidar;
  PacketSequencer sequencer;
  std::vector<std::int64_t> passed;

 private:
  struct Note {
    Sequencing* to;
    void operator()(const ReturnBatch& batch, LidarTime first_firing) const {
      const auto packet = static_cast<std::int64_t>(batch.x_lidar[0]) / test::kFiringsPerPacket;
      EXPECT_EQ(first_firing, to->lidar.time(packet));
      to->passed.push_back(packet);
    }
  };
  Note note_{this};
};

TEST(PacketSequencer, InOrderIsPassedAtOnceAndUncopied) {
  SyntheticLidar lidar;
  PacketSequencer sequencer;
  for (std::int64_t n = 0; n < 2000; ++n) {
    const TimedBatch timed = lidar.packet(n);
    const ReturnBatch* passed = nullptr;
    sequencer.push(timed.batch, timed.first_firing,
                   [&](const ReturnBatch& batch, LidarTime) { passed = &batch; });
    ASSERT_EQ(passed, &timed.batch) << n;
  }
  EXPECT_EQ(sequencer.counters().lost.value(), 0U);
  EXPECT_EQ(sequencer.counters().duplicates.value(), 0U);
}

TEST(PacketSequencer, DuplicateIsDroppedAndCounted) {
  Sequencing s;
  s.push({0, 0, 1, 2, 1, 0, 2, 3});
  EXPECT_THAT(s.passed, ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(s.sequencer.counters().duplicates.value(), 4U);
  EXPECT_EQ(s.sequencer.counters().late.value(), 0U);
}

TEST(PacketSequencer, DuplicateOfAHeldDatagramIsDroppedAndCounted) {
  Sequencing s;
  s.push({0, 2, 2, 3, 2, 1});
  EXPECT_THAT(s.passed, ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(s.sequencer.counters().duplicates.value(), 2U);
}

TEST(PacketSequencer, OvertakenDatagramsArePutBack) {
  Sequencing s;
  s.push({0, 2, 1, 4, 5, 6, 3, 7});
  EXPECT_THAT(s.passed, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  EXPECT_EQ(s.sequencer.counters().reordered.value(), 2U);
  EXPECT_EQ(s.sequencer.counters().lost.value(), 0U);
}

TEST(PacketSequencer, GapIsGivenUpWhenMoreThanTheWindowCameAfterIt) {
  Sequencing s(2);
  s.push({0, 2, 3});
  EXPECT_THAT(s.passed, ElementsAre(0));
  s.push(4);
  EXPECT_THAT(s.passed, ElementsAre(0, 2, 3, 4));
  EXPECT_EQ(s.sequencer.counters().lost.value(), 1U);
}

TEST(PacketSequencer, DatagramWhosePlaceWasGivenUpIsLate) {
  Sequencing s(2);
  s.push({0, 2, 3, 4, 1, 5});
  EXPECT_THAT(s.passed, ElementsAre(0, 2, 3, 4, 5));
  EXPECT_EQ(s.sequencer.counters().late.value(), 1U);
  EXPECT_EQ(s.sequencer.counters().duplicates.value(), 0U);
}

TEST(PacketSequencer, SecondGapStaysOpenWhenTheFirstIsGivenUp) {
  Sequencing s(3);
  s.push({0, 2, 4, 5, 6});
  EXPECT_THAT(s.passed, ElementsAre(0, 2));
  s.push(3);
  EXPECT_THAT(s.passed, ElementsAre(0, 2, 3, 4, 5, 6));
  EXPECT_EQ(s.sequencer.counters().lost.value(), 1U);
}

TEST(PacketSequencer, FullWindowPassesTheEarliestEvenWhenItIsTheOneInHand) {
  Sequencing s(2);
  s.push({0, 4, 5, 2, 6});
  s.flush();
  EXPECT_THAT(s.passed, ElementsAre(0, 2, 4, 5, 6));
  EXPECT_EQ(s.sequencer.counters().lost.value(), 2U);
}

TEST(PacketSequencer, LossIsCountedFromTheSensorsClock) {
  for (const std::int64_t lost : {1, 2, 17, 180, 1800}) {
    Sequencing s;
    s.push({0, 1});
    for (std::int64_t n = 0; n < 10; ++n) s.push(2 + lost + n);
    EXPECT_EQ(s.sequencer.counters().lost.value(), static_cast<std::uint64_t>(lost));
    EXPECT_EQ(s.passed.size(), 12U);
  }
}

TEST(PacketSequencer, FlushPassesWhatIsHeld) {
  Sequencing s;
  s.push({0, 3, 2});
  s.flush();
  EXPECT_THAT(s.passed, ElementsAre(0, 2, 3));
  EXPECT_EQ(s.sequencer.counters().lost.value(), 1U);
}

TEST(PacketSequencer, HalfASpanPacketsOfDualReturnAreFollowed) {
  PacketSequencer sequencer;
  std::uint64_t passed = 0;
  for (std::int64_t n = 0; n < 100; ++n) {
    TimedBatch timed = test::packet_of({0, 15, 30, 45, 60, 75}, LidarTime{});
    const Duration elapsed{n * 6 * test::kFiringPeriodNs};
    timed.first_firing = LidarTime{std::chrono::floor<std::chrono::microseconds>(elapsed)};
    sequencer.push(timed.batch, timed.first_firing,
                   [&](const ReturnBatch&, LidarTime) { ++passed; });
  }
  EXPECT_EQ(passed, 100U);
  EXPECT_EQ(sequencer.counters().lost.value(), 0U);
}

TEST(PacketSequencer, TimeThatGoesBackFarIsARestart) {
  Sequencing s;
  s.push({10'000, 10'001, 10'003, 0, 1, 2});
  EXPECT_THAT(s.passed, ElementsAre(10'000, 10'001, 10'003, 0, 1, 2));
  EXPECT_EQ(s.sequencer.counters().resyncs.value(), 1U);
  EXPECT_EQ(s.sequencer.counters().lost.value(), 1U);  // the one in the gap before
}

TEST(PacketSequencer, SilenceOfMoreThanASecondIsARestart) {
  Sequencing s;
  s.push({0, 1, 2000, 2001});
  EXPECT_THAT(s.passed, ElementsAre(0, 1, 2000, 2001));
  EXPECT_EQ(s.sequencer.counters().resyncs.value(), 1U);
  EXPECT_EQ(s.sequencer.counters().lost.value(), 0U);
}

TEST(PacketSequencer, ClockSetBackALittleIsFollowedAfterAWhile) {
  Sequencing s;
  for (std::int64_t n = 0; n < 1000; ++n) s.push(n);
  for (std::int64_t n = 500; n < 700; ++n) s.push(n);
  EXPECT_EQ(s.sequencer.counters().resyncs.value(), 1U);
  EXPECT_EQ(s.passed.back(), 699);
}

TEST(PacketSequencer, FrozenClockPassesNextToNothing) {
  Sequencing s;
  for (int i = 0; i < 1000; ++i) s.push(7);
  EXPECT_LE(s.passed.size(), 1000U / 64U + 1U);
}

TEST(PacketSequencer, ManyRepetitionsAreNoRestart) {
  Sequencing s;
  for (int i = 0; i < 64; ++i) s.push(7);
  s.push(8);
  EXPECT_THAT(s.passed, ElementsAre(7, 8));
  EXPECT_EQ(s.sequencer.counters().resyncs.value(), 0U);
}

TEST(PacketSequencer, BatchWithoutFiringsIsIgnored) {
  PacketSequencer sequencer;
  const ReturnBatch empty{};
  bool called = false;
  sequencer.push(empty, LidarTime{}, [&](const ReturnBatch&, LidarTime) { called = true; });
  EXPECT_FALSE(called);
}

TEST(PacketSequencer, WindowOutOfRangeIsRefused) {
  EXPECT_THROW(PacketSequencer(0), std::invalid_argument);
  EXPECT_THROW(PacketSequencer(33), std::invalid_argument);
}

// Random loss, repetition and overtaking by up to the window: what is passed on is exactly what was
// sent and not lost, once and in order, and the counters add up.
TEST(PacketSequencer, AnyOvertakingWithinTheWindowIsUndone) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    const auto window = static_cast<std::int64_t>(1 + random() % 8);
    std::vector<std::pair<std::int64_t, std::int64_t>> arrivals{{0, 0}};
    std::vector<std::int64_t> kept{0};
    std::uint64_t repeated = 0;
    const std::int64_t count = 500;
    for (std::int64_t n = 1; n < count; ++n) {
      if (random() % 10 == 0 && n + 1 < count) continue;
      kept.push_back(n);
      arrivals.emplace_back(
          n + static_cast<std::int64_t>(random() % static_cast<unsigned>(window + 1)), n);
      if (random() % 10 == 0) {
        arrivals.emplace_back(arrivals.back().first + 3, n);
        ++repeated;
      }
    }
    std::stable_sort(arrivals.begin(), arrivals.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Sequencing s(static_cast<std::size_t>(window));
    for (const auto& arrival : arrivals) s.push(arrival.second);
    s.flush();
    ASSERT_EQ(s.passed, kept) << seed;
    const SequencerCounters& counters = s.sequencer.counters();
    EXPECT_EQ(counters.lost.value(), static_cast<std::uint64_t>(count) - kept.size());
    EXPECT_EQ(counters.duplicates.value(), repeated);
    EXPECT_EQ(counters.late.value(), 0U);
    EXPECT_EQ(counters.resyncs.value(), 0U);
  }
}

}  // namespace
}  // namespace convexcut
