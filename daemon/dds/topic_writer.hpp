// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/counter.hpp"
#include "daemon/dds/participant.hpp"
#include "daemon/dds/ros2_type.hpp"

namespace convexcut::daemon {

enum class PublishStatus : std::uint8_t {
  sent,       // handed to the network, and to the readers of this process
  no_reader,  // nobody listens: nothing was serialised
  timed_out,  // the readers did not keep up for dds.max_blocking_ms: not sent to all
  failed,     // Cyclone DDS refused it
};

struct ReaderStatus {
  std::uint32_t matched = 0;       // now
  std::uint32_t incompatible = 0;  // readers so far that asked for more than we offer
  std::string_view last_policy;    // what the last of these differed in; empty when none
};

// One topic of ours. Publishing is for one thread, not a realtime one: it allocates, locks and may
// block for dds.max_blocking_ms. The counts and the readers may be asked for by any thread.
class TopicWriter {
 public:
  // ros_name is without the rt/ of DDS. DdsError when the name or a setting is refused.
  TopicWriter(const Participant& participant, const Ros2Type& type, std::string_view ros_name,
              const Qos& qos);

  [[nodiscard]] bool has_reader() const noexcept { return readers().matched > 0; }
  // sample is of the topic's C type and is serialised before the call returns.
  PublishStatus write(const void* sample) noexcept;

  [[nodiscard]] ReaderStatus readers() const noexcept;
  [[nodiscard]] std::uint64_t sent() const noexcept { return sent_.value(); }
  [[nodiscard]] std::uint64_t timed_out() const noexcept { return timed_out_.value(); }
  [[nodiscard]] std::uint64_t failed() const noexcept { return failed_.value(); }
  [[nodiscard]] const std::string& dds_name() const noexcept { return dds_name_; }
  [[nodiscard]] dds_entity_t handle() const noexcept { return writer_.get(); }

 private:
  std::string dds_name_;
  Entity topic_;
  Entity writer_;
  Counter sent_;
  Counter timed_out_;
  Counter failed_;
};

}  // namespace convexcut::daemon
