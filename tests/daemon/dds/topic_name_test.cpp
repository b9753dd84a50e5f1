// SPDX-License-Identifier: Apache-2.0
//
// Does not prove that nobody else uses a name: DDS allows several writers of a topic.
#include "daemon/dds/topic_name.hpp"

#include <gtest/gtest.h>

#include "daemon/dds/entity.hpp"

namespace convexcut::daemon {
namespace {

TEST(DdsTopicName, HasRos2sPrefixWithOneSlash) {
  EXPECT_EQ(dds_topic_name("points"), "rt/points");
  EXPECT_EQ(dds_topic_name("/points"), "rt/points");
  EXPECT_EQ(dds_topic_name("robot_1/imu/data"), "rt/robot_1/imu/data");
}

TEST(DdsTopicName, RefusesWhatRos2CouldNotName) {
  for (const char* name : {"", "/", "//a", "a/", "a//b", "1a", "a/2b", "a b", "a-b", "~a", "ä"}) {
    EXPECT_THROW(static_cast<void>(dds_topic_name(name)), DdsError) << name;
  }
}

}  // namespace
}  // namespace convexcut::daemon
