// SPDX-License-Identifier: Apache-2.0
#include "daemon/dds/qos.hpp"

#include <string>

namespace convexcut::daemon {
namespace {

Qos common_qos(std::int32_t depth, const Ros2Type& type) {
  Qos qos(dds_create_qos());
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  // Said outright: ROS 2 accepts nothing else, and the default is the type's, not ours.
  const dds_data_representation_id_t plain_cdr = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &plain_cdr);
  const std::string user_data = "typehash=" + std::string(type.type_hash) + ";";
  dds_qset_userdata(qos.get(), user_data.data(), user_data.size());
  return qos;
}

Qos writer_qos(config::Reliability reliability, std::int32_t depth, const config::Dds& settings,
               const Ros2Type& type) {
  Qos qos = common_qos(depth, type);
  dds_qset_reliability(qos.get(),
                       reliability == config::Reliability::reliable ? DDS_RELIABILITY_RELIABLE
                                                                    : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_MSECS(settings.max_blocking_ms));
  // A writer that goes away disposes of nothing: ROS 2's topics have no instances.
  dds_qset_writer_data_lifecycle(qos.get(), false);
  return qos;
}

}  // namespace

Qos cloud_writer_qos(const config::Dds& settings, const Ros2Type& type) {
  return writer_qos(settings.reliability, kCloudDepth, settings, type);
}

Qos message_writer_qos(const config::Dds& settings, const Ros2Type& type) {
  return writer_qos(config::Reliability::reliable, kMessageDepth, settings, type);
}

Qos reader_qos(std::int32_t depth, const Ros2Type& type) {
  Qos qos = common_qos(depth, type);
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  return qos;
}

std::string_view policy_name(std::uint32_t policy_id) noexcept {
  switch (policy_id) {
    case DDS_DURABILITY_QOS_POLICY_ID:
      return "DURABILITY";
    case DDS_DEADLINE_QOS_POLICY_ID:
      return "DEADLINE";
    case DDS_LATENCYBUDGET_QOS_POLICY_ID:
      return "LATENCY_BUDGET";
    case DDS_OWNERSHIP_QOS_POLICY_ID:
      return "OWNERSHIP";
    case DDS_LIVELINESS_QOS_POLICY_ID:
      return "LIVELINESS";
    case DDS_RELIABILITY_QOS_POLICY_ID:
      return "RELIABILITY";
    case DDS_DESTINATIONORDER_QOS_POLICY_ID:
      return "DESTINATION_ORDER";
    case DDS_PRESENTATION_QOS_POLICY_ID:
      return "PRESENTATION";
    case DDS_DATA_REPRESENTATION_QOS_POLICY_ID:
      return "DATA_REPRESENTATION";
    case DDS_TYPE_CONSISTENCY_ENFORCEMENT_QOS_POLICY_ID:
      return "TYPE_CONSISTENCY";
    default:
      return "another policy";
  }
}

}  // namespace convexcut::daemon
