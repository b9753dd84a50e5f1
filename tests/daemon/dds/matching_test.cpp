// SPDX-License-Identifier: Apache-2.0
//
// Which readers our writers match, in one process. Does not prove that remote readers match:
// network_test does, for Cyclone DDS.
#include <gtest/gtest.h>

#include "daemon/dds/publisher.hpp"
#include "daemon/dds/qos.hpp"
#include "support/test_domain.hpp"
#include "support/test_reader.hpp"

namespace convexcut::daemon {
namespace {

using testing::ros2_default_qos;
using testing::test_settings;
using testing::TestReader;

constexpr const char* kStructure = "rt/convexcut/structure";

class MatchingTest : public ::testing::Test {
 protected:
  static config::Dds best_effort_settings() {
    config::Dds settings = test_settings();
    settings.reliability = config::Reliability::best_effort;
    return settings;
  }
};

TEST_F(MatchingTest, AReliableWriterMatchesBothKindsOfReader) {
  const Participant participant(test_settings());
  const ScanPublisher publisher(participant, test_settings());
  const TestReader reliable(participant, kPointCloud2Type, kStructure, ros2_default_qos().get());
  const TestReader best_effort(participant, kPointCloud2Type, kStructure,
                               reader_qos(5, kPointCloud2Type).get());
  EXPECT_EQ(reliable.matched_writers(), 1U);
  EXPECT_EQ(best_effort.matched_writers(), 1U);
  EXPECT_EQ(publisher.structure().readers().matched, 2U);
  EXPECT_EQ(publisher.structure().readers().incompatible, 0U);
  EXPECT_EQ(publisher.structure().readers().last_policy, "");
}

TEST_F(MatchingTest, ABestEffortWriterNamesTheReliabilityThatAReaderWanted) {
  const Participant participant(test_settings());
  const ScanPublisher publisher(participant, best_effort_settings());
  const TestReader reliable(participant, kPointCloud2Type, kStructure, ros2_default_qos().get());
  EXPECT_EQ(publisher.structure().readers().matched, 0U);
  EXPECT_EQ(publisher.structure().readers().incompatible, 1U);
  EXPECT_EQ(publisher.structure().readers().last_policy, "RELIABILITY");
}

TEST_F(MatchingTest, AReaderThatWantsOldSamplesIsNamed) {
  const Participant participant(test_settings());
  const ScanPublisher publisher(participant, test_settings());
  const Qos qos = ros2_default_qos();
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  const TestReader reader(participant, kPointCloud2Type, kStructure, qos.get());
  EXPECT_EQ(publisher.structure().readers().last_policy, "DURABILITY");
}

TEST_F(MatchingTest, AReaderOfTheNewerEncodingIsNamed) {
  const Participant participant(test_settings());
  const ScanPublisher publisher(participant, test_settings());
  const Qos qos = ros2_default_qos();
  const dds_data_representation_id_t newer = DDS_DATA_REPRESENTATION_XCDR2;
  dds_qset_data_representation(qos.get(), 1, &newer);
  const TestReader reader(participant, kPointCloud2Type, kStructure, qos.get());
  EXPECT_EQ(publisher.structure().readers().matched, 0U);
  EXPECT_EQ(publisher.structure().readers().last_policy, "DATA_REPRESENTATION");
}

TEST_F(MatchingTest, AReaderOfAnotherTopicDoesNotMatch) {
  const Participant participant(test_settings());
  const ScanPublisher publisher(participant, test_settings());
  const TestReader reader(participant, kPointCloud2Type, "convexcut/structure",
                          ros2_default_qos().get());
  EXPECT_EQ(reader.matched_writers(), 0U);
}

}  // namespace
}  // namespace convexcut::daemon
