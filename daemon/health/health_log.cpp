// SPDX-License-Identifier: Apache-2.0
#include "daemon/health/health_log.hpp"

#include <cstring>

#include "daemon/log/log.hpp"

namespace convexcut::daemon {
namespace {

using config::LogLevel;

double milliseconds(Duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}
double whole_seconds(Duration duration) {
  return std::chrono::duration<double>(std::chrono::floor<std::chrono::seconds>(duration)).count();
}

// "lidar:streaming imu:stale"
std::string states_of(const std::vector<SourceHealth>& sources) {
  std::string text;
  for (const SourceHealth& source : sources) {
    if (!text.empty()) text += ' ';
    text.append(source.name).append(":").append(name_of(source.state));
  }
  return text;
}

LogLevel level_of(DaemonState state) {
  if (state == DaemonState::faulty) return LogLevel::error;
  return state == DaemonState::degraded ? LogLevel::warning : LogLevel::info;
}

const StageSummary& of(const HealthSnapshot& snapshot, Stage stage) {
  return snapshot.stages[static_cast<std::size_t>(stage)];
}

HealthLine source_line(const SourceHealth& source) {
  HealthLine line{LogLevel::info, "health_source", {}};
  line.fields = {{"name", source.name},
                 {"state", name_of(source.state)},
                 {"valid", source.reading.valid},
                 {"invalid", source.reading.invalid},
                 {"lost", source.reading.lost},
                 {"valid_hz", source.valid_hz},
                 {"invalid_hz", source.invalid_hz}};
  if (source.since_valid) line.fields.emplace_back("silent_ms", milliseconds(*source.since_valid));
  if (source.reading.last_error != 0) {
    line.fields.emplace_back("last_error", std::strerror(source.reading.last_error));
  }
  return line;
}

HealthLine clock_line(const SensorClock& clock) {
  return {LogLevel::info,
          "health_clock",
          {{"name", clock.name},
           {"source", name_of(clock.health.source)},
           {"locked", clock.health.locked},
           {"offset_ms", milliseconds(clock.health.offset)},
           {"jitter_ms", milliseconds(clock.health.jitter)},
           {"skew_ppm", clock.health.skew_ppm},
           {"steps", clock.health.steps}}};
}

HealthLine stage_line(const StageInfo& stage, const StageSummary& summary) {
  return {LogLevel::info,
          "health_stage",
          {{"name", stage.name},
           {"count", summary.count},
           {"p50_ms", milliseconds(summary.p50)},
           {"p99_ms", milliseconds(summary.p99)},
           {"p99.9_ms", milliseconds(summary.p999)},
           {"max_ms", milliseconds(summary.max)}}};
}

}  // namespace

HealthLine summary_line(const HealthSnapshot& snapshot) {
  const StageSummary& latency = of(snapshot, Stage::latency);
  return {level_of(snapshot.state),
          "health",
          {{"state", name_of(snapshot.state)},
           {"reasons", joined(snapshot.reasons)},
           {"sources", states_of(snapshot.sources)},
           {"uptime_s", whole_seconds(snapshot.uptime)},
           {"results", snapshot.totals.results},
           {"late", snapshot.totals.late_results},
           {"latency_p50_ms", milliseconds(latency.p50)},
           {"latency_p99_ms", milliseconds(latency.p99)},
           {"latency_p99.9_ms", milliseconds(latency.p999)},
           {"latency_max_ms", milliseconds(latency.max)}}};
}

std::vector<HealthLine> detail_lines(const HealthSnapshot& snapshot) {
  std::vector<HealthLine> lines{summary_line(snapshot)};
  lines.front().level = LogLevel::info;  // it was asked for, nothing has happened
  for (const SourceHealth& source : snapshot.sources) lines.push_back(source_line(source));
  for (const SensorClock& clock : snapshot.clocks) lines.push_back(clock_line(clock));
  for (const StageInfo& stage : kStages)
    lines.push_back(stage_line(stage, of(snapshot, stage.stage)));
  HealthLine totals{LogLevel::info, "health_totals", {}};
  for (const CounterInfo& counter : kHealthCounters) {
    totals.fields.emplace_back(counter.name, snapshot.totals.*counter.value);
  }
  lines.push_back(std::move(totals));
  return lines;
}

std::vector<HealthLine> HealthChanges::lines(const HealthSnapshot& snapshot) {
  std::vector<HealthLine> lines;
  for (const SourceHealth& source : snapshot.sources) {
    const auto [known, is_new] = sources_.try_emplace(source.name, source.state);
    const SourceState before = known->second;
    known->second = source.state;
    if (!is_new && before == source.state) continue;
    HealthLine line{source.state == SourceState::stale || source.state == SourceState::faulty
                        ? LogLevel::warning
                        : LogLevel::info,
                    "source",
                    {{"name", source.name}, {"state", name_of(source.state)}}};
    if (!is_new) line.fields.emplace_back("was", name_of(before));
    if (source.reading.last_error != 0) {
      line.fields.emplace_back("last_error", std::strerror(source.reading.last_error));
    }
    lines.push_back(std::move(line));
  }
  if (snapshot.state == DaemonState::ok || snapshot.state == DaemonState::starting) told_.clear();
  bool has_new_reason = false;
  if (snapshot.state == DaemonState::degraded || snapshot.state == DaemonState::faulty) {
    for (const Reason& reason : snapshot.reasons) {
      has_new_reason = told_.insert(reason.text).second || has_new_reason;
    }
  }
  if (snapshot.state != daemon_ || has_new_reason) {
    HealthLine line{level_of(snapshot.state),
                    "daemon",
                    {{"state", name_of(snapshot.state)}, {"was", name_of(daemon_)}}};
    if (!snapshot.reasons.empty()) line.fields.emplace_back("reasons", joined(snapshot.reasons));
    lines.push_back(std::move(line));
    daemon_ = snapshot.state;
  }
  return lines;
}

void write(const HealthLine& line) { log::write(line.level, line.event, line.fields); }

}  // namespace convexcut::daemon
