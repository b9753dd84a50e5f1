// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/time.hpp"

namespace convexcut::recording {

// One recorded stream on its way into a driver, record by record, in the file's order. Live sources
// deliver to the same drivers; only where the bytes come from differs. One thread.
class RecordedStream {
 public:
  RecordedStream() = default;
  RecordedStream(const RecordedStream&) = delete;
  RecordedStream& operator=(const RecordedStream&) = delete;
  virtual ~RecordedStream() = default;

  // When the next record was received; nothing at the end of the recording.
  [[nodiscard]] virtual std::optional<HostTime> next_stamp() = 0;
  // Hands that record to the driver. Precondition: next_stamp() gave a time.
  virtual void deliver() = 0;
  // After the last record: hands on what the driver still holds back.
  virtual void finish() = 0;

  // One line that says what is wrong with the file when it did not end regularly, otherwise empty.
  [[nodiscard]] virtual std::string problem() const = 0;

  // How far the reading has come, for progress bars.
  [[nodiscard]] virtual std::uint64_t bytes_read() const = 0;
  [[nodiscard]] virtual std::uint64_t bytes_total() const = 0;
};

}  // namespace convexcut::recording
