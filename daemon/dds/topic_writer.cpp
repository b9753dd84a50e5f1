// SPDX-License-Identifier: Apache-2.0
#include "daemon/dds/topic_writer.hpp"

#include "daemon/dds/qos.hpp"
#include "daemon/dds/topic_name.hpp"

namespace convexcut::daemon {

TopicWriter::TopicWriter(const Participant& participant, const Ros2Type& type,
                         std::string_view ros_name, const Qos& qos)
    : dds_name_(dds_topic_name(ros_name)),
      topic_(require(dds_create_topic(participant.handle(), type.descriptor, dds_name_.c_str(),
                                      nullptr, nullptr),
                     "DDS topic " + dds_name_)),
      writer_(require(dds_create_writer(participant.handle(), topic_.get(), qos.get(), nullptr),
                      "DDS writer of " + dds_name_)) {}

PublishStatus TopicWriter::write(const void* sample) noexcept {
  const dds_return_t result = dds_write(writer_.get(), sample);
  if (result == DDS_RETCODE_OK) {
    sent_.add();
    return PublishStatus::sent;
  }
  if (result == DDS_RETCODE_TIMEOUT) {
    timed_out_.add();
    return PublishStatus::timed_out;
  }
  failed_.add();
  return PublishStatus::failed;
}

ReaderStatus TopicWriter::readers() const noexcept {
  ReaderStatus readers;
  dds_publication_matched_status_t matched{};
  if (dds_get_publication_matched_status(writer_.get(), &matched) == DDS_RETCODE_OK) {
    readers.matched = matched.current_count;
  }
  dds_offered_incompatible_qos_status_t incompatible{};
  if (dds_get_offered_incompatible_qos_status(writer_.get(), &incompatible) == DDS_RETCODE_OK &&
      incompatible.total_count > 0) {
    readers.incompatible = incompatible.total_count;
    readers.last_policy = policy_name(incompatible.last_policy_id);
  }
  return readers;
}

}  // namespace convexcut::daemon
