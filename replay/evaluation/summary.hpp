// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace convexcut::evaluation {

// Mean, spread and worst of a figure over scans, in one pass (B. P. Welford, "Note on a method for
// calculating corrected sums of squares and products", Technometrics 4, 1962).
class Summary {
 public:
  void add(double value) noexcept;

  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] double mean() const noexcept { return mean_; }  // 0 without values
  // Of the sample (n − 1); 0 with less than two values.
  [[nodiscard]] double standard_deviation() const noexcept;
  // The least: of scores, larger is better. 0 without values.
  [[nodiscard]] double worst() const noexcept { return worst_; }
  // Which value that was, counted from 0; the first of equals.
  [[nodiscard]] std::size_t worst_at() const noexcept { return worst_at_; }

 private:
  std::size_t count_ = 0;
  double mean_ = 0.0;
  double squares_ = 0.0;  // sum of squared distances from the mean
  double worst_ = 0.0;
  std::size_t worst_at_ = 0;
};

}  // namespace convexcut::evaluation
