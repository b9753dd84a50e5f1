// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "config/config.hpp"
#include "daemon/dds/domain.hpp"
#include "daemon/dds/entity.hpp"

namespace convexcut::daemon {

// A participant of the domain that the configuration names. Outlives all writers and readers that
// are made with it. To ROS 2 it is a bare DDS program: its topics are seen, a node is not.
class Participant {
 public:
  // DdsError, in one line that names the configuration's key.
  explicit Participant(const config::Dds& settings);

  [[nodiscard]] dds_entity_t handle() const noexcept { return entity_.get(); }
  [[nodiscard]] std::uint32_t domain() const noexcept { return domain_->number(); }

 private:
  std::shared_ptr<Domain> domain_;  // above entity_: closed after it
  Entity entity_;
};

}  // namespace convexcut::daemon
