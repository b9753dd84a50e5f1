// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "replay/evaluation/evaluation.hpp"

namespace convexcut::evaluation {

// The scans whose errors are worth a look: that of the least F and that of the middle one (of
// points). Indices into Evaluation::scans, without repetition.
[[nodiscard]] std::vector<std::size_t> scans_to_show(const Evaluation& evaluation);

// An error map of one of them.
struct ErrorMap {
  std::size_t scan = 0;  // index into Evaluation::scans
  std::string png;
};

// One HTML page with all plots and pictures in it: no other file, no script, nothing from the net.
[[nodiscard]] std::string report_html(const Evaluation& evaluation, const std::string& title,
                                      const std::vector<ErrorMap>& maps);

}  // namespace convexcut::evaluation
