// SPDX-License-Identifier: Apache-2.0
//
// The kernel's drop count. Does not prove that the kernel counts right: udp_source_test does.
#include "drivers/live/drop_count.hpp"

#include <gtest/gtest.h>

namespace convexcut::live {
namespace {

TEST(DropCount, OnlyNewDropsAreGiven) {
  DropCount drops;
  EXPECT_EQ(drops.advance(0), 0U);
  EXPECT_EQ(drops.advance(3), 3U);
  EXPECT_EQ(drops.advance(3), 0U);
  EXPECT_EQ(drops.advance(10), 7U);
}

TEST(DropCount, AnOlderCountAddsNothingAndDoesNotCountTwice) {
  DropCount drops;
  EXPECT_EQ(drops.advance(10), 10U);
  EXPECT_EQ(drops.advance(4), 0U);
  EXPECT_EQ(drops.advance(10), 0U);
  EXPECT_EQ(drops.advance(11), 1U);
}

TEST(DropCount, WrapsWithItsThirtyTwoBits) {
  DropCount drops;
  EXPECT_EQ(drops.advance(0x7FFFFFFF), 0x7FFFFFFFU);
  EXPECT_EQ(drops.advance(0xFFFFFFF0), 0x7FFFFFF1U);
  EXPECT_EQ(drops.advance(5), 21U);
  EXPECT_EQ(drops.advance(0xFFFFFFFF), 0U);
}

}  // namespace
}  // namespace convexcut::live
