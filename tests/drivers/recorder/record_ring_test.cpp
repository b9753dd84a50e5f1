// SPDX-License-Identifier: Apache-2.0
//
// Records go through unchanged. The ring below is tested in tests/core/ring/.
#include "drivers/recorder/record_ring.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/drivers/recorder/records.hpp"

namespace convexcut::recorder {
namespace {

using ::testing::ElementsAreArray;

void expect_same(const capture::Record& got, const capture::Record& sent) {
  EXPECT_EQ(got.stamp, sent.stamp);
  EXPECT_EQ(got.kind, sent.kind);
  EXPECT_EQ(got.source, sent.source);
  EXPECT_EQ(got.destination, sent.destination);
  EXPECT_EQ(got.source_port, sent.source_port);
  EXPECT_EQ(got.destination_port, sent.destination_port);
  EXPECT_THAT(got.payload, ElementsAreArray(sent.payload));
}

TEST(RecordRing, RecordsComeOutAsTheyWentIn) {
  RecordRing ring(1 << 16);
  const auto packet = testing::payload_of(1, 1206);
  const auto bytes = testing::payload_of(2, 37);
  capture::Record without_addresses = testing::datagram(3, packet);
  without_addresses.source.reset();
  without_addresses.destination.reset();
  const capture::Record empty = testing::read_of(4, {});
  for (const capture::Record& sent :
       {testing::datagram(1, packet), testing::read_of(2, bytes), without_addresses, empty}) {
    ring.on_record(sent);
    capture::Record got;
    ASSERT_TRUE(ring.front(got));
    expect_same(got, sent);
    ring.pop();
    EXPECT_FALSE(ring.front(got));
  }
}

TEST(RecordRing, DropsAndCountsTheNewestWhenTheWriterIsBehind) {
  RecordRing ring(4096);
  const auto packet = testing::payload_of(0, 1206);
  for (std::uint64_t number = 0; number < 5; ++number) {
    ring.on_record(testing::datagram(number, packet));
  }
  EXPECT_EQ(ring.overruns(), 2U);
  capture::Record got;
  ASSERT_TRUE(ring.front(got));
  EXPECT_EQ(got.stamp, testing::datagram(0, packet).stamp);
}

}  // namespace
}  // namespace convexcut::recorder
