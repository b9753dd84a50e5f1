// SPDX-License-Identifier: Apache-2.0
#include "replay/health_report.hpp"

#include <cstring>
#include <utility>
#include <vector>

namespace convexcut::replay {
namespace {

using daemon::CounterInfo;
using daemon::HealthSnapshot;
using daemon::kHealthCounters;
using daemon::kStages;
using daemon::name_of;
using daemon::SensorClock;
using daemon::SourceHealth;
using daemon::StageInfo;
using daemon::StageSummary;

const StageSummary& of(const HealthSnapshot& health, const StageInfo& info) {
  return health.stages[static_cast<std::size_t>(info.stage)];
}

// "up 1:02:03"
std::string uptime(Duration span) {
  const auto total = std::chrono::duration_cast<std::chrono::seconds>(span).count();
  return format("up %lld:%02lld:%02lld", static_cast<long long>(total / 3600),
                static_cast<long long>(total / 60 % 60), static_cast<long long>(total % 60));
}

std::string source_line(const SourceHealth& source, const HealthSnapshot& health) {
  std::string line =
      format("  %-6s %-9s %8.1f Hz  %s valid, %s invalid, %s lost", source.name.c_str(),
             std::string(name_of(source.state)).c_str(), source.valid_hz,
             grouped(source.reading.valid).c_str(), grouped(source.reading.invalid).c_str(),
             grouped(source.reading.lost).c_str());
  for (const SensorClock& clock : health.clocks) {
    if (clock.name == source.name) line += ", time: " + std::string(name_of(clock.health.source));
  }
  if (source.state != daemon::SourceState::streaming && source.reading.last_error != 0) {
    line += std::string(", ") + std::strerror(source.reading.last_error);
  }
  return line + "\n";
}

std::string stage_line(const StageInfo& info, const StageSummary& stage) {
  return format("  %-16s %9s %9.3f %9.3f %9.3f %9.3f\n", std::string(info.name).c_str(),
                grouped(stage.count).c_str(), milliseconds(stage.p50), milliseconds(stage.p99),
                milliseconds(stage.p999), milliseconds(stage.max));
}

JsonObject source_json(const SourceHealth& source) {
  JsonObject json;
  json.add("name", source.name)
      .add("state", name_of(source.state))
      .add("required", source.required)
      .add("valid_hz", source.valid_hz, 1)
      .add("invalid_hz", source.invalid_hz, 1)
      .add("valid", source.reading.valid)
      .add("invalid", source.reading.invalid)
      .add("lost", source.reading.lost);
  if (source.since_valid) json.add("silence_s", seconds(*source.since_valid), 3);
  if (source.reading.last_error != 0) {
    json.add("last_error", std::strerror(source.reading.last_error));
  }
  return json;
}

JsonObject clock_json(const SensorClock& clock) {
  JsonObject json;
  json.add("name", clock.name)
      .add("source", name_of(clock.health.source))
      .add("locked", clock.health.locked)
      .add("offset_ms", milliseconds(clock.health.offset), 3)
      .add("jitter_ms", milliseconds(clock.health.jitter), 3)
      .add("skew_ppm", clock.health.skew_ppm, 2)
      .add("steps", std::uint64_t{clock.health.steps});
  return json;
}

JsonObject stage_json(const StageInfo& info, const StageSummary& stage) {
  JsonObject json;
  json.add("name", info.name)
      .add("count", stage.count)
      .add("p50_ms", milliseconds(stage.p50), 3)
      .add("p99_ms", milliseconds(stage.p99), 3)
      .add("p99.9_ms", milliseconds(stage.p999), 3)
      .add("max_ms", milliseconds(stage.max), 3);
  return json;
}

}  // namespace

std::string state_and_reasons(const HealthSnapshot& health) {
  const std::string reasons = joined(health.reasons);
  return std::string(name_of(health.state)) + (reasons.empty() ? "" : ": " + reasons);
}

std::string health_block(const HealthSnapshot& health) {
  std::string block = "daemon " + state_and_reasons(health) + ", " + uptime(health.uptime) + "\n";
  for (const SourceHealth& source : health.sources) block += source_line(source, health);
  bool heading = false;
  for (const StageInfo& info : kStages) {
    if (of(health, info).count == 0) continue;
    if (!std::exchange(heading, true)) {
      block += "  stage                count    p50 ms    p99 ms  p99.9 ms    max ms\n";
    }
    block += stage_line(info, of(health, info));
  }
  std::string totals;
  for (const CounterInfo& counter : kHealthCounters) {
    const std::uint64_t value = health.totals.*counter.value;
    if (value == 0) continue;
    totals += (totals.empty() ? "  " : ", ") + std::string(counter.name) + " " + grouped(value);
  }
  return block + (totals.empty() ? "" : totals + "\n");
}

JsonObject health_json(const HealthSnapshot& health) {
  std::vector<JsonObject> sources;
  std::vector<JsonObject> clocks;
  std::vector<JsonObject> stages;
  JsonObject totals;
  sources.reserve(health.sources.size());
  clocks.reserve(health.clocks.size());
  stages.reserve(kStages.size());
  for (const SourceHealth& source : health.sources) sources.push_back(source_json(source));
  for (const SensorClock& clock : health.clocks) clocks.push_back(clock_json(clock));
  for (const StageInfo& info : kStages) stages.push_back(stage_json(info, of(health, info)));
  for (const CounterInfo& counter : kHealthCounters) {
    totals.add(counter.name, health.totals.*counter.value);
  }
  JsonObject json;
  json.add("state", name_of(health.state))
      .add("reasons", joined(health.reasons))
      .add("uptime_s", seconds(health.uptime), 1)
      .add("sources", sources)
      .add("clocks", clocks)
      .add("stages", stages)
      .add("totals", totals);
  return json;
}

bool HealthStates::changed(const HealthSnapshot& health) {
  std::string now = state_and_reasons(health);
  for (const SourceHealth& source : health.sources) {
    now.append(" ").append(source.name).append(name_of(source.state));
  }
  if (last_ == now) return false;
  last_ = std::move(now);
  return true;
}

}  // namespace convexcut::replay
