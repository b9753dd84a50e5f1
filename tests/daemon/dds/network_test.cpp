// SPDX-License-Identifier: Apache-2.0
//
// Samples to another process, over UDP on the loopback interface. Does not prove that other DDS
// implementations read them, nor how a lossy network behaves.
#include <gtest/gtest.h>

#include "daemon/dds/publisher.hpp"
#include "support/peer_process.hpp"
#include "support/test_domain.hpp"
#include "support/test_reader.hpp"

namespace convexcut::daemon {
namespace {

using testing::made_up_scan;
using testing::PeerProcess;

// Of an HDL-32E at 10 Hz: 1.67 MB, some 1240 fragments.
constexpr std::size_t kWholeScan = 69'444;

// The reader has matched before the writer has: the writer's side of discovery may be behind.
void wait_for_reader(const TopicWriter& writer) {
  const Entity waitset = require(dds_create_waitset(dds_get_participant(writer.handle())), "");
  dds_set_status_mask(writer.handle(), DDS_PUBLICATION_MATCHED_STATUS);
  dds_waitset_attach(waitset.get(), writer.handle(), 0);
  while (!writer.has_reader()) {
    dds_attach_t triggered;
    ASSERT_GT(dds_waitset_wait(waitset.get(), &triggered, 1, DDS_SECS(20)), 0) << "no reader came";
  }
}

TEST(Network, AWholeScanReachesAReliableReaderInAnotherProcess) {
  const config::Dds settings = testing::test_settings();
  const Participant participant(settings);
  ScanPublisher publisher(participant, settings);
  PeerProcess peer(settings, "rt/convexcut/points");
  ASSERT_EQ(peer.read_line(), "ready");
  wait_for_reader(publisher.points());
  const LevelledScan scan = made_up_scan(kWholeScan);
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(publisher.publish_points(scan), PublishStatus::sent);
    ASSERT_EQ(peer.read_line(), "points 69444 1666656");
  }
  ASSERT_EQ(publisher.publish_points(LevelledScan{}), PublishStatus::sent);
  EXPECT_EQ(peer.read_line(), "points 0 0");
}

TEST(Network, AReaderThatHangsLosesScansButNeverHoldsUpTheWriter) {
  const config::Dds settings = testing::test_settings();
  const Participant participant(settings);
  ScanPublisher publisher(participant, settings);
  PeerProcess peer(settings, "rt/convexcut/points");
  ASSERT_EQ(peer.read_line(), "ready");
  wait_for_reader(publisher.points());
  peer.stop();
  const LevelledScan scan = made_up_scan(kWholeScan);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(publisher.publish_points(scan), PublishStatus::sent);
  peer.carry_on();
  EXPECT_EQ(peer.read_line(), "points 69444 1666656");
}

}  // namespace
}  // namespace convexcut::daemon
