// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/time.hpp"
#include "replay/feed/played_time.hpp"

namespace convexcut::replay {

// One recorded sensor on its way to a live input, record by record. One thread. Everything may
// throw std::runtime_error of one line.
class Feed {
 public:
  Feed() = default;
  Feed(const Feed&) = delete;
  Feed& operator=(const Feed&) = delete;
  virtual ~Feed() = default;

  // When the next record was recorded; nothing at the end.
  [[nodiscard]] virtual std::optional<HostTime> next_stamp() = 0;
  // Sends that record as the sensor would send it now. Precondition: next_stamp() gave a time.
  virtual void send(const PlayedTime& time) = 0;
  // Passes over that record, as if the sensor had been silent.
  virtual void skip() = 0;
  // Begins anew with the first record.
  virtual void rewind() = 0;
  // The least time between two records that were sent, for the time after the last one.
  [[nodiscard]] virtual Duration record_interval() const noexcept = 0;
};

}  // namespace convexcut::replay
