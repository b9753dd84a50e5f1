// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/scan/scan.hpp"
#include "daemon/dds/entity.hpp"
#include "daemon/dds/participant.hpp"
#include "daemon/dds/ros2_type.hpp"

namespace convexcut::daemon::testing {

// The QoS of readers in ROS 2 (RELIABLE VOLATILE KEEP_LAST 10), without type hash.
[[nodiscard]] Qos ros2_default_qos();

// A reader in this process: it matches when it is made, and has a sample when the write returns.
class TestReader {
 public:
  TestReader(const Participant& participant, const Ros2Type& type, std::string_view dds_topic,
             const dds_qos_t* qos);

  [[nodiscard]] dds_entity_t handle() const noexcept { return reader_.get(); }
  [[nodiscard]] std::uint32_t matched_writers() const;
  // The oldest sample as it was serialised, with the four bytes of encapsulation; empty when none.
  [[nodiscard]] std::vector<std::uint8_t> take_cdr();

  // Calls use(const T&) for the oldest sample; false when there is none.
  template <class T, class Use>
  bool take(Use use) {
    void* sample = nullptr;
    dds_sample_info_t info;
    const dds_return_t count = dds_take(reader_.get(), &sample, &info, 1, 1);
    if (count < 1) return false;
    if (info.valid_data) use(*static_cast<const T*>(sample));
    static_cast<void>(dds_return_loan(reader_.get(), &sample, count));
    return info.valid_data;
  }

 private:
  Entity topic_;
  Entity reader_;
};

// A scan of n points with different values everywhere, every third point structure.
[[nodiscard]] LevelledScan made_up_scan(std::size_t n);

}  // namespace convexcut::daemon::testing
