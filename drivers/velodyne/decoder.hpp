// SPDX-License-Identifier: Apache-2.0
//
// Data packet → ReturnBatch, for one sensor model.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/return_batch.hpp"
#include "drivers/velodyne/azimuth_steps.hpp"
#include "drivers/velodyne/block_kernels.hpp"
#include "drivers/velodyne/data_packet.hpp"
#include "drivers/velodyne/model.hpp"
#include "drivers/wire.hpp"

namespace convexcut::velodyne {

struct DecoderOptions {
  // Adds to z the height at which each beam leaves the sensor, as the envelope drawing 86-0106 has
  // it (up to 17 mm). Off, the points are those of VeloView and ROS, which let all beams leave from
  // the origin.
  bool vertical_offsets = false;
};

// Positions, with r the range, ω the laser's elevation and α its own azimuth (frame lidar):
//   x = r·cosω·cosα,  y = −r·cosω·sinα,  z = r·sinω
// The rounding to float is all of the error: below 0.01 mm at 131 m, the farthest of 2 mm units.
//
// A block's azimuth and the packet's timestamp belong to the first firing of either. A laser that
// fires t after its block's first has the azimuth α_block + Δ·t/T, with T the block period and Δ
// the block's azimuth step, plus the laser's own offset. Firing::azimuth is without that offset:
// the rotor's azimuth.
//
// Dual returns: the even block of a pair has the last echoes, the odd one the strongest (VLP-16
// manual p. 57). Both are emitted, adjacent, last before strongest. Where they are at the same
// distance, or one of them is missing, one return is emitted, as Echo::only.
//
// Thread: any one. RT: no allocation, no lock, no system call.
class DataDecoder {
 public:
  explicit DataDecoder(const Model& model, DecoderOptions options = {}) noexcept;

  // Leaves `out` untouched unless the status is ok; else sets all of it but `pps`, which a data
  // packet does not tell.
  [[nodiscard]] DecodeStatus decode(wire::Bytes payload, HostTime arrival,
                                    ReturnBatch& out) const noexcept;

  [[nodiscard]] const Model& model() const noexcept { return model_; }

 private:
  struct Block;

  template <bool kDual>
  void decode_blocks(wire::Bytes payload, ReturnBatch& out) const noexcept;
  void decode_single(const Block& block, ReturnBatch& out) const noexcept;
  void decode_pair(const Block& block, ReturnBatch& out) const noexcept;
  Firing& begin_firing(const Block& block, std::size_t first_slot, ReturnBatch& out) const noexcept;

  Model model_;
  std::int32_t max_step_;  // 0.01° a block
  SlotTable slots_;
  SlotTable::Column<std::int64_t> share_q32_{};  // slots_.block_share × 2³²
};

}  // namespace convexcut::velodyne
