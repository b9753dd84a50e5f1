// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/model_detector.hpp"

#include <span>

#include "drivers/velodyne/data_packet.hpp"
#include "drivers/velodyne/wire_layout.hpp"

namespace convexcut::velodyne {
namespace {

constexpr std::size_t kDecidingSteps = 3;

// Timestamps are whole microseconds: a step is within one of the truth.
constexpr std::int64_t kToleranceNs = 1'500;

// Multiples of different periods come together again at 3318 µs (6 × HDL-32E, 5 × VLP-32C).
constexpr std::uint32_t kMaxStepUs = 3'000;

}  // namespace

std::optional<ModelId> ModelDetector::observe(wire::Bytes payload) noexcept {
  const MicrosPastHour now = timestamp(payload);
  const bool dual = has_dual_returns(payload);
  product_ = product(payload);
  if (has_previous_ && dual == previous_dual_) {
    const std::uint32_t step =
        (now.count + wire_layout::kMicrosPerHour - previous_.count) % wire_layout::kMicrosPerHour;
    if (const Candidates fitting = that_fit(step, dual); fitting != 0) {
      candidates_ &= fitting;
      ++usable_steps_;
    }
  }
  has_previous_ = true;
  previous_dual_ = dual;
  previous_ = now;
  if (usable_steps_ < kDecidingSteps || candidates_ == 0) return std::nullopt;
  return conclude();
}

std::optional<ModelId> ModelDetector::conclude() const noexcept {
  const std::optional<ModelId> named = model_of_product(product_);
  // Steps that contradict each other (two sensors on one network) are no evidence at all.
  if (usable_steps_ == 0 || candidates_ == 0) return named;
  const Model* longest = nullptr;
  for (const Model& model : all_models()) {
    if ((candidates_ >> static_cast<unsigned>(model.id) & 1U) == 0) continue;
    if (model.id == named) return named;
    if (longest == nullptr || model.packet_period_ns(false) > longest->packet_period_ns(false)) {
      longest = &model;
    }
  }
  if (longest == nullptr) return named;
  return longest->id;
}

ModelDetector::Candidates ModelDetector::that_fit(std::uint32_t step_us, bool dual) noexcept {
  if (step_us > kMaxStepUs) return 0;
  const std::int64_t step_ns = std::int64_t{step_us} * 1'000;
  Candidates fitting = 0;
  for (const Model& model : all_models()) {
    const std::int64_t period_ns = model.packet_period_ns(dual);
    const std::int64_t packets = (step_ns + period_ns / 2) / period_ns;
    const std::int64_t error_ns = step_ns - packets * period_ns;
    if (packets >= 1 && error_ns <= kToleranceNs && error_ns >= -kToleranceNs) {
      fitting |= Candidates{1} << static_cast<unsigned>(model.id);
    }
  }
  return fitting;
}

}  // namespace convexcut::velodyne
