// SPDX-License-Identifier: Apache-2.0
//
// Does not prove anything about real time: the clock's readings are made up.
#include "daemon/log/rate_limit.hpp"

#include <gtest/gtest.h>

namespace convexcut::daemon::log {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr RateLimit::Clock::time_point kStart{};

TEST(RateLimit, LetsTheFirstEventPass) {
  RateLimit limit(seconds{1});
  EXPECT_EQ(limit.pass(kStart), 0U);
}

TEST(RateLimit, CountsWhatItHoldsBackAndTellsWithTheNextThatPasses) {
  RateLimit limit(seconds{1});
  EXPECT_TRUE(limit.pass(kStart).has_value());
  for (int i = 1; i <= 9; ++i) EXPECT_FALSE(limit.pass(kStart + i * milliseconds{100}).has_value());
  EXPECT_EQ(limit.pass(kStart + seconds{1}), 9U);
  EXPECT_FALSE(limit.pass(kStart + seconds{1}).has_value());
  EXPECT_EQ(limit.pass(kStart + seconds{5}), 1U);
}

}  // namespace
}  // namespace convexcut::daemon::log
