// SPDX-License-Identifier: Apache-2.0
#include "replay/evaluation/summary.hpp"

#include <cmath>

namespace convexcut::evaluation {

void Summary::add(double value) noexcept {
  if (count_ == 0 || value < worst_) {
    worst_ = value;
    worst_at_ = count_;
  }
  ++count_;
  const double before = value - mean_;
  mean_ += before / static_cast<double>(count_);
  squares_ += before * (value - mean_);
}

double Summary::standard_deviation() const noexcept {
  return count_ < 2 ? 0.0 : std::sqrt(squares_ / static_cast<double>(count_ - 1));
}

}  // namespace convexcut::evaluation
