// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/return_batch.hpp"
#include "core/sink.hpp"
#include "daemon/pipeline/pipeline.hpp"

namespace convexcut::daemon {

// Feeds the pipeline directly: no ring, no thread, so that order and result are always the same.
// `pipeline` outlives it.
class LidarInput final : public Sink<ReturnBatch> {
 public:
  explicit LidarInput(Pipeline& pipeline) : pipeline_(pipeline) {}
  [[nodiscard]] ReturnBatch* claim() noexcept override { return &batch_; }
  void commit() noexcept override { pipeline_.on_lidar(batch_); }

 private:
  Pipeline& pipeline_;
  ReturnBatch batch_;
};

}  // namespace convexcut::daemon
