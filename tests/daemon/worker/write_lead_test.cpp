// SPDX-License-Identifier: Apache-2.0
//
// When a write begins. Does not prove how long writes take.
#include "daemon/write_lead.hpp"

#include <gtest/gtest.h>

namespace convexcut::daemon {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

TEST(WriteLead, BeginsWithTheFirstWriteAndStaysWithEqualOnes) {
  WriteLead lead;
  EXPECT_EQ(lead.value(), Duration::zero());
  for (int i = 0; i < 10; ++i) {
    lead.observe(microseconds{800});
    EXPECT_EQ(lead.value(), microseconds{800});
  }
}

TEST(WriteLead, ALongWriteMovesItLittle) {
  WriteLead lead;
  lead.observe(microseconds{800});
  lead.observe(milliseconds{500});
  EXPECT_EQ(lead.value(), microseconds{800} + WriteLead::kLargestStep);
}

TEST(WriteLead, FollowsALoadThatStays) {
  WriteLead lead;
  lead.observe(microseconds{200});
  for (int i = 0; i < 200; ++i) lead.observe(microseconds{1'000});
  EXPECT_NEAR(static_cast<double>(lead.value().count()), 1e6, 100.0);
  for (int i = 0; i < 200; ++i) lead.observe(microseconds{300});
  EXPECT_NEAR(static_cast<double>(lead.value().count()), 3e5, 100.0);
}

TEST(WriteLead, IsNeverLongerThanTheLongest) {
  WriteLead lead;
  lead.observe(milliseconds{50});
  EXPECT_EQ(lead.value(), WriteLead::kLongest);
}

}  // namespace
}  // namespace convexcut::daemon
