// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "daemon/health/snapshot.hpp"

namespace convexcut::daemon {

// Of the HTTP answer that carries prometheus_text().
inline constexpr std::string_view kPrometheusContentType =
    "text/plain; version=0.0.4; charset=utf-8";

// The snapshot in Prometheus's text exposition format 0.0.4
// (https://prometheus.io/docs/instrumenting/exposition_formats/): names in convexcut_…, base units,
// counters end in _total, one series a state of which one is 1.
[[nodiscard]] std::string prometheus_text(const HealthSnapshot& snapshot);

}  // namespace convexcut::daemon
