// SPDX-License-Identifier: Apache-2.0
//
// The ring behind the drivers' interface. What the ring itself does is proved elsewhere.
#include "core/ring/ring_sink.hpp"

#include <gtest/gtest.h>

namespace convexcut {
namespace {

TEST(RingSink, ACommittedSampleArrivesInTheRing) {
  SpscRing<int> ring(2);
  RingSink<int> ring_sink(ring);
  Sink<int>& sink = ring_sink;
  int* slot = sink.claim();
  ASSERT_NE(slot, nullptr);
  *slot = 42;
  sink.commit();
  ASSERT_NE(ring.front(), nullptr);
  EXPECT_EQ(*ring.front(), 42);
}

TEST(RingSink, AFullRingGivesNoSlotAndCountsTheLoss) {
  SpscRing<int> ring(1);
  RingSink<int> sink(ring);
  ASSERT_NE(sink.claim(), nullptr);
  sink.commit();
  EXPECT_EQ(sink.claim(), nullptr);
  EXPECT_EQ(ring.overruns(), 1U);
}

}  // namespace
}  // namespace convexcut
