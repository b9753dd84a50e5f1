// SPDX-License-Identifier: Apache-2.0
//
// Tells the sensor model from its first data packets. What gives it away is the time from one
// packet to the next, which no firmware has wrong; the product byte lies on old firmware (a 2014
// VLP-16 says 0x21) and decides only between what the times leave open.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/time.hpp"
#include "drivers/velodyne/model.hpp"
#include "drivers/wire.hpp"

namespace convexcut::velodyne {

// Every timestamp step must be a multiple of the model's packet period: µs, single and dual return
//   HDL-32E 552.96, 276.48 · VLP-16 and Puck Hi-Res 1327.104, 663.552 · VLP-32C 663.552, 331.776
// Lost packets make larger multiples, which fit too; a step that fits no model (the clock was set)
// is passed over. Of several models that fit all steps, the one that the product byte names wins,
// then the one with the longest period, which needs no packet to have been lost. The Puck Hi-Res
// differs from the VLP-16 in nothing but the product byte.
//
// Thread: any one. RT: no allocation, no lock, no system call.
class ModelDetector {
 public:
  // After so many packets conclude() is as good as it gets.
  static constexpr std::size_t kMaxPackets = 8;

  // Takes the next payload that check_data_packet() has accepted. The model, once three steps agree
  // on it.
  [[nodiscard]] std::optional<ModelId> observe(wire::Bytes payload) noexcept;

  // The best guess from the packets so far, in the end from the product byte alone. Nothing when
  // that byte is unknown too.
  [[nodiscard]] std::optional<ModelId> conclude() const noexcept;

 private:
  using Candidates = std::uint32_t;  // bit n: the n-th of all_models()

  [[nodiscard]] static Candidates that_fit(std::uint32_t step_us, bool dual) noexcept;

  Candidates candidates_ = ~Candidates{0};
  std::size_t usable_steps_ = 0;
  bool has_previous_ = false;
  bool previous_dual_ = false;
  MicrosPastHour previous_{};
  std::uint8_t product_ = 0;
};

}  // namespace convexcut::velodyne
