// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "core/return_batch.hpp"
#include "core/sink.hpp"

namespace convexcut::velodyne::test {

// Keeps every committed batch, up to a capacity.
class CollectingSink final : public Sink<ReturnBatch> {
 public:
  explicit CollectingSink(std::size_t capacity = std::numeric_limits<std::size_t>::max())
      : capacity_(capacity) {}

  ReturnBatch* claim() noexcept override { return batches.size() < capacity_ ? &slot_ : nullptr; }
  void commit() noexcept override { batches.push_back(slot_); }

  std::vector<ReturnBatch> batches;

 private:
  std::size_t capacity_;
  ReturnBatch slot_;
};

}  // namespace convexcut::velodyne::test
