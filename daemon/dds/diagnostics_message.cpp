// SPDX-License-Identifier: Apache-2.0
#include "daemon/dds/diagnostics_message.hpp"

#include <array>
#include <charconv>
#include <cstring>

#include "daemon/dds/ros2_time.hpp"

namespace convexcut::daemon {
namespace {

// diagnostic_msgs/msg/DiagnosticStatus. Its STALE is for who does not report at all.
constexpr std::uint8_t kOk = 0;
constexpr std::uint8_t kWarn = 1;
constexpr std::uint8_t kError = 2;

std::uint8_t level_of(DaemonState state) noexcept {
  switch (state) {
    case DaemonState::ok:
      return kOk;
    case DaemonState::starting:
    case DaemonState::degraded:
      return kWarn;
    case DaemonState::faulty:
      break;
  }
  return kError;
}

std::uint8_t level_of(const SourceHealth& source, DaemonState daemon) noexcept {
  if (source.state == SourceState::streaming) return kOk;
  const bool may_still_come =
      daemon == DaemonState::starting && source.state != SourceState::faulty;
  return source.required && !may_still_come ? kError : kWarn;
}

std::string number(double value, int decimals) {
  std::array<char, 64> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::fixed, decimals);
  return {text.data(), end.ec == std::errc{} ? end.ptr : text.data()};
}

std::string milliseconds(Duration duration) {
  return number(std::chrono::duration<double, std::milli>(duration).count(), 3);
}

}  // namespace

const diagnostic_msgs_msg_dds__DiagnosticArray_& DiagnosticsMessage::fill(
    const HealthSnapshot& snapshot) {
  texts_.clear();
  statuses_.clear();
  values_.clear();
  values_.reserve(1 + snapshot.sources.size());  // the statuses point at what is in the elements
  add_daemon(snapshot);
  for (const SourceHealth& source : snapshot.sources) add_source(source, snapshot);
  message_.header.stamp = to_ros2_time(snapshot.stamp);
  message_.header.frame_id = texts_.keep("");
  message_.status = sequence_of<decltype(message_.status)>(statuses_);
  return message_;
}

void DiagnosticsMessage::add_daemon(const HealthSnapshot& snapshot) {
  values_.emplace_back();
  add_value("uptime_s", number(std::chrono::duration<double>(snapshot.uptime).count(), 0));
  for (const CounterInfo& counter : kHealthCounters) {
    add_value(counter.name, std::to_string(snapshot.totals.*counter.value));
  }
  for (const StageInfo& info : kStages) {
    const StageSummary& stage = snapshot.stages[static_cast<std::size_t>(info.stage)];
    const std::string name(info.name);
    add_value(name + "_p50_ms", milliseconds(stage.p50));
    add_value(name + "_p99_ms", milliseconds(stage.p99));
    add_value(name + "_p99.9_ms", milliseconds(stage.p999));
    add_value(name + "_max_ms", milliseconds(stage.max));
  }
  const std::string reasons = joined(snapshot.reasons);
  add_status(level_of(snapshot.state), "daemon",
             std::string(name_of(snapshot.state)) + (reasons.empty() ? "" : ": " + reasons));
}

void DiagnosticsMessage::add_source(const SourceHealth& source, const HealthSnapshot& snapshot) {
  values_.emplace_back();
  add_value("valid", std::to_string(source.reading.valid));
  add_value("invalid", std::to_string(source.reading.invalid));
  add_value("lost", std::to_string(source.reading.lost));
  add_value("valid_hz", number(source.valid_hz, 1));
  add_value("invalid_hz", number(source.invalid_hz, 1));
  for (const SensorClock& clock : snapshot.clocks) {
    if (clock.name != source.name) continue;
    add_value("time_source", name_of(clock.health.source));
    add_value("clock_offset_ms", milliseconds(clock.health.offset));
    add_value("clock_jitter_ms", milliseconds(clock.health.jitter));
    add_value("clock_skew_ppm", number(clock.health.skew_ppm, 1));
  }
  std::string message(name_of(source.state));
  if (source.reading.last_error != 0 && source.state != SourceState::streaming) {
    message.append(": ").append(std::strerror(source.reading.last_error));
  }
  add_status(level_of(source, snapshot.state), source.name, message);
}

void DiagnosticsMessage::add_status(std::uint8_t level, std::string_view name,
                                    std::string_view message) {
  diagnostic_msgs_msg_dds__DiagnosticStatus_ status{};
  status.level = level;
  status.name = texts_.keep("convexcut: " + std::string(name));
  status.message = texts_.keep(message);
  status.hardware_id = texts_.keep(name);
  status.values = sequence_of<decltype(status.values)>(values_.back());
  statuses_.push_back(status);
}

void DiagnosticsMessage::add_value(std::string_view key, std::string_view value) {
  values_.back().push_back({texts_.keep(key), texts_.keep(value)});
}

}  // namespace convexcut::daemon
