// SPDX-License-Identifier: Apache-2.0
//
// An evaluation as a table for people and as JSON for programs.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "replay/evaluation/evaluation.hpp"

namespace convexcut::evaluation {

// The surfaces with points that were judged wrongly, most first. Indices into by_surface.
[[nodiscard]] std::vector<std::size_t> surfaces_by_errors(const Evaluation& evaluation);

// The name that the scene gives a surface.
[[nodiscard]] std::string surface_name(const Evaluation& evaluation, std::size_t surface);

// "0.951 ± 0.012"
[[nodiscard]] std::string mean_text(const Summary& summary);

// Lines: one a scan (when `each_scan`), the totals, the surfaces with the most errors.
[[nodiscard]] std::string report_table(const Evaluation& evaluation, bool each_scan);

// One JSON object on one line. docs/evaluate.md names its members.
[[nodiscard]] std::string report_json(const Evaluation& evaluation);

}  // namespace convexcut::evaluation
