// SPDX-License-Identifier: Apache-2.0
//
// Times of methods that take turns, so that what else the machine does hits all of them alike.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace convexcut::bench {

struct Contender {
  std::string name;
  std::function<void()> run;
  unsigned runs_a_round = 1;      // of the quick ones more, for a steady median
  std::function<void()> after{};  // each run, not measured
};

struct Timing {
  std::string name;
  double median_ms = 0.0;
  double p99_ms = 0.0;
  double max_ms = 0.0;
};

// In the order of the contenders; each runs once before it is measured.
[[nodiscard]] std::vector<Timing> measure(const std::vector<Contender>& contenders,
                                          unsigned rounds);

}  // namespace convexcut::bench
