// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/ring/spsc_ring.hpp"
#include "core/sink.hpp"

namespace convexcut {

// The producing end of a ring, as drivers see it. The ring outlives it; one thread only.
template <class Sample>
class RingSink final : public Sink<Sample> {
 public:
  explicit RingSink(SpscRing<Sample>& ring) noexcept : ring_(&ring) {}

  [[nodiscard]] Sample* claim() noexcept override { return ring_->claim(); }
  void commit() noexcept override { ring_->commit(); }

 private:
  SpscRing<Sample>* ring_;
};

}  // namespace convexcut
