// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/sink.hpp"

namespace convexcut::daemon {

// Takes and forgets: what samples go to that are decoded but not used. One thread.
template <class Sample>
class NullSink final : public Sink<Sample> {
 public:
  [[nodiscard]] Sample* claim() noexcept override { return &sample_; }
  void commit() noexcept override {}

 private:
  Sample sample_;
};

}  // namespace convexcut::daemon
