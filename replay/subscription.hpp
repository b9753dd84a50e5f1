// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <sys/eventfd.h>

#include "daemon/dds/participant.hpp"
#include "daemon/dds/qos.hpp"
#include "daemon/dds/ros2_type.hpp"
#include "daemon/dds/topic_name.hpp"
#include "drivers/live/file_descriptor.hpp"

namespace convexcut::replay {

// A reader that writes to an eventfd, which outlives it, when data has come.
class Subscription {
 public:
  Subscription(const daemon::Participant& participant, const daemon::Ros2Type& type,
               std::string_view ros_name, std::int32_t depth, live::FileDescriptor& data_came)
      : name_(daemon::dds_topic_name(ros_name)),
        topic_(daemon::require(dds_create_topic(participant.handle(), type.descriptor,
                                                name_.c_str(), nullptr, nullptr),
                               name_)) {
    dds_listener_t* listener = dds_create_listener(&data_came);
    dds_lset_data_available(listener, [](dds_entity_t, void* argument) {
      ::eventfd_write(static_cast<const live::FileDescriptor*>(argument)->get(), 1);
    });
    const dds_entity_t reader = dds_create_reader(participant.handle(), topic_.get(),
                                                  daemon::reader_qos(depth, type).get(), listener);
    dds_delete_listener(listener);
    reader_ = daemon::require(reader, name_);
  }

  // Calls use(const T&) for everything that has come.
  template <class T, class Use>
  void take_all(Use use) {
    void* sample = nullptr;
    dds_sample_info_t info;
    while (dds_take(reader_.get(), &sample, &info, 1, 1) == 1) {
      if (info.valid_data) use(*static_cast<const T*>(sample));
      static_cast<void>(dds_return_loan(reader_.get(), &sample, 1));
      sample = nullptr;
    }
  }

  [[nodiscard]] std::uint32_t publishers() const {
    dds_subscription_matched_status_t status{};
    static_cast<void>(dds_get_subscription_matched_status(reader_.get(), &status));
    return status.current_count;
  }

  // "" unless a publisher of the topic offers less than we ask for.
  [[nodiscard]] std::string incompatibility() const {
    dds_requested_incompatible_qos_status_t status{};
    static_cast<void>(dds_get_requested_incompatible_qos_status(reader_.get(), &status));
    if (status.total_count == 0) return "";
    return name_ + " has a publisher with incompatible QoS: " +
           std::string(daemon::policy_name(status.last_policy_id));
  }

 private:
  std::string name_;
  daemon::Entity topic_;
  daemon::Entity reader_;
};

}  // namespace convexcut::replay
