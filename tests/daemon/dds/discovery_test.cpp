// SPDX-License-Identifier: Apache-2.0
//
// What ROS 2 programs learn of our topics, read from DDS's own discovery topics. Does not prove
// that ROS 2 accepts it; that it is what ROS 2 asks for is from its sources (docs/design/dds.md).
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/dds/health_publisher.hpp"
#include "daemon/dds/publisher.hpp"
#include "support/test_domain.hpp"

namespace convexcut::daemon {
namespace {

struct Announced {
  std::string type_name;
  std::string user_data;
  std::vector<dds_data_representation_id_t> representations;
  dds_reliability_kind_t reliability{};
  dds_duration_t max_blocking = 0;
  dds_history_kind_t history{};
  std::int32_t depth = 0;
  dds_durability_kind_t durability{};
  bool autodispose = true;
  std::uint32_t partitions = 0;
};

Announced announced(const dds_builtintopic_endpoint_t& endpoint) {
  Announced result;
  result.type_name = endpoint.type_name;
  void* user_data = nullptr;
  std::size_t size = 0;
  if (dds_qget_userdata(endpoint.qos, &user_data, &size)) {
    result.user_data.assign(static_cast<const char*>(user_data), size);
    dds_free(user_data);
  }
  std::uint32_t count = 0;
  dds_data_representation_id_t* representations = nullptr;
  if (dds_qget_data_representation(endpoint.qos, &count, &representations)) {
    result.representations.assign(representations, representations + count);
    dds_free(representations);
  }
  dds_qget_reliability(endpoint.qos, &result.reliability, &result.max_blocking);
  dds_qget_history(endpoint.qos, &result.history, &result.depth);
  dds_qget_durability(endpoint.qos, &result.durability);
  dds_qget_writer_data_lifecycle(endpoint.qos, &result.autodispose);
  char** partitions = nullptr;
  if (dds_qget_partition(endpoint.qos, &result.partitions, &partitions)) {
    for (std::uint32_t i = 0; i < result.partitions; ++i) dds_free(partitions[i]);
    dds_free(partitions);
  }
  return result;
}

// By topic name: all writers that DDS knows of.
std::map<std::string, Announced> announced_writers(const Participant& participant) {
  const Entity reader = require(
      dds_create_reader(participant.handle(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr),
      "DCPSPublication");
  std::map<std::string, Announced> writers;
  void* sample = nullptr;
  dds_sample_info_t info;
  while (dds_take(reader.get(), &sample, &info, 1, 1) == 1) {
    if (info.valid_data) {
      const auto& endpoint = *static_cast<const dds_builtintopic_endpoint_t*>(sample);
      writers[endpoint.topic_name] = announced(endpoint);
    }
    static_cast<void>(dds_return_loan(reader.get(), &sample, 1));
    sample = nullptr;
  }
  return writers;
}

class DiscoveryTest : public ::testing::Test {
 protected:
  static std::map<std::string, Announced> publish(const config::Dds& settings) {
    const Participant participant(settings);
    const ScanPublisher scans(participant, settings);
    const ImuPublisher imu(participant, settings);
    const StatusPublisher status(participant, settings);
    const HealthPublisher health(participant, settings);
    return announced_writers(participant);
  }
};

TEST_F(DiscoveryTest, TopicsAndTypesHaveTheNamesThatRos2LooksFor) {
  const auto writers = publish(testing::test_settings());
  ASSERT_EQ(writers.size(), 6U);
  EXPECT_EQ(writers.at("rt/convexcut/structure").type_name, "sensor_msgs::msg::dds_::PointCloud2_");
  EXPECT_EQ(writers.at("rt/convexcut/points").type_name, "sensor_msgs::msg::dds_::PointCloud2_");
  EXPECT_EQ(writers.at("rt/imu/data").type_name, "sensor_msgs::msg::dds_::Imu_");
  EXPECT_EQ(writers.at("rt/convexcut/status").type_name, "convexcut::msg::dds_::ScanStatus_");
  EXPECT_EQ(writers.at("rt/convexcut/health").type_name, "convexcut::msg::dds_::Health_");
  EXPECT_EQ(writers.at("rt/diagnostics").type_name, "diagnostic_msgs::msg::dds_::DiagnosticArray_");
}

TEST_F(DiscoveryTest, TopicNamesAreTheConfigurations) {
  config::Dds settings = testing::test_settings();
  settings.structure_topic = "/robot/walls";
  settings.points_topic = "robot/points";
  settings.imu_topic = "robot/imu";
  const auto writers = publish(settings);
  EXPECT_TRUE(writers.contains("rt/robot/walls"));
  EXPECT_TRUE(writers.contains("rt/robot/points"));
  EXPECT_TRUE(writers.contains("rt/robot/imu"));
}

TEST_F(DiscoveryTest, EveryWriterTellsItsTypeHash) {
  const auto writers = publish(testing::test_settings());
  EXPECT_EQ(writers.at("rt/convexcut/points").user_data,
            "typehash=RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5;");
  EXPECT_EQ(writers.at("rt/imu/data").user_data,
            "typehash=RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b;");
  EXPECT_EQ(writers.at("rt/diagnostics").user_data,
            "typehash=RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e;");
  for (const auto& [topic, writer] : writers) {
    EXPECT_TRUE(writer.user_data.starts_with("typehash=RIHS01_")) << topic;
    EXPECT_EQ(writer.user_data.size(), 81U) << topic;
  }
}

TEST_F(DiscoveryTest, EveryWriterOffersPlainCdrAlone) {
  for (const auto& [topic, writer] : publish(testing::test_settings())) {
    EXPECT_EQ(writer.representations,
              std::vector<dds_data_representation_id_t>{DDS_DATA_REPRESENTATION_XCDR1})
        << topic;
  }
}

TEST_F(DiscoveryTest, WritersAreReliableVolatileAndKeepTheLast) {
  for (const auto& [topic, writer] : publish(testing::test_settings())) {
    EXPECT_EQ(writer.reliability, DDS_RELIABILITY_RELIABLE) << topic;
    EXPECT_EQ(writer.max_blocking, DDS_MSECS(50)) << topic;
    EXPECT_EQ(writer.history, DDS_HISTORY_KEEP_LAST) << topic;
    EXPECT_EQ(writer.durability, DDS_DURABILITY_VOLATILE) << topic;
    EXPECT_FALSE(writer.autodispose) << topic;
    EXPECT_EQ(writer.partitions, 0U) << topic;
  }
}

TEST_F(DiscoveryTest, CloudsKeepTwoSamplesAndSmallMessagesAHundred) {
  const auto writers = publish(testing::test_settings());
  EXPECT_EQ(writers.at("rt/convexcut/structure").depth, 2);
  EXPECT_EQ(writers.at("rt/convexcut/points").depth, 2);
  EXPECT_EQ(writers.at("rt/imu/data").depth, 100);
  EXPECT_EQ(writers.at("rt/convexcut/status").depth, 100);
}

TEST_F(DiscoveryTest, CloudsAreBestEffortWhenConfigured) {
  config::Dds settings = testing::test_settings();
  settings.reliability = config::Reliability::best_effort;
  const auto writers = publish(settings);
  EXPECT_EQ(writers.at("rt/convexcut/structure").reliability, DDS_RELIABILITY_BEST_EFFORT);
  EXPECT_EQ(writers.at("rt/convexcut/points").reliability, DDS_RELIABILITY_BEST_EFFORT);
  EXPECT_EQ(writers.at("rt/imu/data").reliability, DDS_RELIABILITY_RELIABLE);
  EXPECT_EQ(writers.at("rt/convexcut/status").reliability, DDS_RELIABILITY_RELIABLE);
}

// A participant with an enclave but without ros_discovery_info shows as a nameless node.
TEST_F(DiscoveryTest, TheParticipantDoesNotPretendToBeARosNode) {
  const Participant participant(testing::test_settings());
  const Qos qos(dds_create_qos());
  ASSERT_EQ(dds_get_qos(participant.handle(), qos.get()), DDS_RETCODE_OK);
  void* user_data = nullptr;
  std::size_t size = 0;
  dds_qget_userdata(qos.get(), &user_data, &size);
  dds_free(user_data);
  EXPECT_EQ(size, 0U);
}

}  // namespace
}  // namespace convexcut::daemon
