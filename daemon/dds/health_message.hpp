// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "daemon/dds/ros2.h"
#include "daemon/dds/text_pool.hpp"
#include "daemon/health/snapshot.hpp"

namespace convexcut::daemon {

// A convexcut/msg/Health whose memory is ours. One thread.
class HealthMessage {
 public:
  HealthMessage() = default;
  HealthMessage(const HealthMessage&) = delete;  // the message points into this object
  HealthMessage& operator=(const HealthMessage&) = delete;

  // Valid until the next call.
  const convexcut_msg_dds__Health_& fill(const HealthSnapshot& snapshot);

 private:
  void add(const SourceHealth& source);
  void add(const SensorClock& clock);
  void add(const StageInfo& info, const StageSummary& stage);

  TextPool texts_;
  std::vector<char*> reasons_;
  std::vector<convexcut_msg_dds__SourceHealth_> sources_;
  std::vector<convexcut_msg_dds__ClockHealth_> clocks_;
  std::vector<convexcut_msg_dds__StageHealth_> stages_;
  std::vector<convexcut_msg_dds__Total_> totals_;
  convexcut_msg_dds__Health_ message_{};
};

// The snapshot that a message was filled from, but for what it does not carry (the sum of a stage,
// the severity of a reason, the link's own word). What a newer daemon has more of is left out; a
// state that is unknown here counts as faulty.
[[nodiscard]] HealthSnapshot snapshot_of(const convexcut_msg_dds__Health_& message);

}  // namespace convexcut::daemon
