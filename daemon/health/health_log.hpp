// SPDX-License-Identifier: Apache-2.0
//
// Health as lines of the log.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/health/snapshot.hpp"
#include "daemon/log/line.hpp"

namespace convexcut::daemon {

struct HealthLine {
  config::LogLevel level = config::LogLevel::info;
  std::string_view event;
  std::vector<log::Field> fields;
};

// All of it in one line.
[[nodiscard]] HealthLine summary_line(const HealthSnapshot& snapshot);
// All of it in detail: the summary, then a line a source, clock, stage, and the totals.
[[nodiscard]] std::vector<HealthLine> detail_lines(const HealthSnapshot& snapshot);

// Finds what has changed since the snapshot before: a line each for a source or the daemon that has
// another state, and for a daemon that has one more reason for the state it is in; each reason is
// told once until it is well again. One thread.
class HealthChanges {
 public:
  [[nodiscard]] std::vector<HealthLine> lines(const HealthSnapshot& snapshot);

 private:
  std::map<std::string, SourceState> sources_;
  DaemonState daemon_ = DaemonState::starting;
  std::set<std::string> told_;  // reasons, since the daemon was well
};

void write(const HealthLine& line);
inline void write(const std::vector<HealthLine>& lines) {
  for (const HealthLine& line : lines) write(line);
}

}  // namespace convexcut::daemon
