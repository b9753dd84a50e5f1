// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/ring/byte_ring.hpp"
#include "drivers/live/raw_tap.hpp"

namespace convexcut::recorder {

// Carries what a receive thread hears to the thread that writes it, by copy. When the writer is
// behind by the whole ring, the newest record is dropped and counted.
class RecordRing final : public live::RawTap {
 public:
  // Allocates; nothing else does.
  explicit RecordRing(std::size_t capacity_bytes) : ring_(capacity_bytes) {}

  // The receive thread. RT.
  void on_record(const capture::Record& record) noexcept override;

  // The writing thread. False when there is none; the payload is valid until pop().
  [[nodiscard]] bool front(capture::Record& record) noexcept;
  void pop() noexcept { ring_.pop(); }

  // Any thread.
  [[nodiscard]] std::uint64_t overruns() const noexcept { return ring_.overruns(); }

 private:
  ByteRing ring_;
};

}  // namespace convexcut::recorder
