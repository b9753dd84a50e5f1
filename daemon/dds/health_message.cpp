// SPDX-License-Identifier: Apache-2.0
#include "daemon/dds/health_message.hpp"

#include "daemon/dds/ros2_time.hpp"

namespace convexcut::daemon {
namespace {

constexpr std::int64_t kNever = -1;

template <class State>
State state_of(std::uint8_t wire) noexcept {
  return wire <= static_cast<std::uint8_t>(State::faulty) ? static_cast<State>(wire)
                                                          : State::faulty;
}

HostTime from_ros2_time(const builtin_interfaces_msg_dds__Time_& time) noexcept {
  return HostTime{std::chrono::seconds{time.sec} + Duration{time.nanosec}};
}

SourceHealth source_of(const convexcut_msg_dds__SourceHealth_& message) {
  SourceHealth source;
  source.name = message.name;
  source.state = state_of<SourceState>(message.state);
  source.required = message.required;
  source.reading.last_error = message.last_error;
  source.reading.valid = message.valid_total;
  source.reading.invalid = message.invalid_total;
  source.reading.lost = message.lost_total;
  if (message.silence_ns >= 0) source.since_valid = Duration{message.silence_ns};
  source.valid_hz = message.valid_hz;
  source.invalid_hz = message.invalid_hz;
  return source;
}

SensorClock clock_of(const convexcut_msg_dds__ClockHealth_& message) {
  SensorClock clock;
  clock.name = message.name;
  constexpr auto kLast = static_cast<std::uint8_t>(TimeSource::pps);
  clock.health.source =
      message.source <= kLast ? static_cast<TimeSource>(message.source) : TimeSource::none;
  clock.health.locked = message.locked;
  clock.health.steps = message.steps;
  clock.health.offset = Duration{message.offset_ns};
  clock.health.jitter = Duration{message.jitter_ns};
  clock.health.skew_ppm = message.skew_ppm;
  return clock;
}

}  // namespace

HealthSnapshot snapshot_of(const convexcut_msg_dds__Health_& message) {
  HealthSnapshot snapshot;
  snapshot.stamp = from_ros2_time(message.stamp);
  snapshot.uptime = Duration{message.uptime_ns};
  snapshot.state = state_of<DaemonState>(message.state);
  for (std::uint32_t i = 0; i < message.reasons._length; ++i) {
    snapshot.reasons.push_back({Severity::degraded, message.reasons._buffer[i]});
  }
  for (std::uint32_t i = 0; i < message.sources._length; ++i) {
    snapshot.sources.push_back(source_of(message.sources._buffer[i]));
  }
  for (std::uint32_t i = 0; i < message.clocks._length; ++i) {
    snapshot.clocks.push_back(clock_of(message.clocks._buffer[i]));
  }
  for (std::uint32_t i = 0; i < message.stages._length; ++i) {
    const convexcut_msg_dds__StageHealth_& stage = message.stages._buffer[i];
    for (const StageInfo& info : kStages) {
      if (info.name != stage.name) continue;
      snapshot.stages[static_cast<std::size_t>(info.stage)] = {stage.count,
                                                               Duration{0},
                                                               Duration{stage.p50_ns},
                                                               Duration{stage.p99_ns},
                                                               Duration{stage.p999_ns},
                                                               Duration{stage.max_ns}};
    }
  }
  for (std::uint32_t i = 0; i < message.totals._length; ++i) {
    for (const CounterInfo& counter : kHealthCounters) {
      if (counter.name != message.totals._buffer[i].name) continue;
      snapshot.totals.*counter.value = message.totals._buffer[i].value;
    }
  }
  return snapshot;
}

const convexcut_msg_dds__Health_& HealthMessage::fill(const HealthSnapshot& snapshot) {
  texts_.clear();
  reasons_.clear();
  sources_.clear();
  clocks_.clear();
  stages_.clear();
  totals_.clear();
  for (const Reason& reason : snapshot.reasons) reasons_.push_back(texts_.keep(reason.text));
  for (const SourceHealth& source : snapshot.sources) add(source);
  for (const SensorClock& clock : snapshot.clocks) add(clock);
  for (const StageInfo& info : kStages) {
    add(info, snapshot.stages[static_cast<std::size_t>(info.stage)]);
  }
  for (const CounterInfo& counter : kHealthCounters) {
    totals_.push_back({texts_.keep(counter.name), snapshot.totals.*counter.value});
  }
  message_.stamp = to_ros2_time(snapshot.stamp);
  message_.uptime_ns = snapshot.uptime.count();
  message_.state = static_cast<std::uint8_t>(snapshot.state);
  message_.reasons = sequence_of<decltype(message_.reasons)>(reasons_);
  message_.sources = sequence_of<decltype(message_.sources)>(sources_);
  message_.clocks = sequence_of<decltype(message_.clocks)>(clocks_);
  message_.stages = sequence_of<decltype(message_.stages)>(stages_);
  message_.totals = sequence_of<decltype(message_.totals)>(totals_);
  return message_;
}

void HealthMessage::add(const SourceHealth& source) {
  convexcut_msg_dds__SourceHealth_ message{};
  message.name = texts_.keep(source.name);
  message.state = static_cast<std::uint8_t>(source.state);
  message.required = source.required;
  message.last_error = source.reading.last_error;
  message.silence_ns = source.since_valid ? source.since_valid->count() : kNever;
  message.valid_hz = source.valid_hz;
  message.invalid_hz = source.invalid_hz;
  message.valid_total = source.reading.valid;
  message.invalid_total = source.reading.invalid;
  message.lost_total = source.reading.lost;
  sources_.push_back(message);
}

void HealthMessage::add(const SensorClock& clock) {
  convexcut_msg_dds__ClockHealth_ message{};
  message.name = texts_.keep(clock.name);
  message.source = static_cast<std::uint8_t>(clock.health.source);
  message.locked = clock.health.locked;
  message.steps = clock.health.steps;
  message.offset_ns = clock.health.offset.count();
  message.jitter_ns = clock.health.jitter.count();
  message.skew_ppm = clock.health.skew_ppm;
  clocks_.push_back(message);
}

void HealthMessage::add(const StageInfo& info, const StageSummary& stage) {
  convexcut_msg_dds__StageHealth_ message{};
  message.name = texts_.keep(info.name);
  message.count = stage.count;
  message.p50_ns = stage.p50.count();
  message.p99_ns = stage.p99.count();
  message.p999_ns = stage.p999.count();
  message.max_ns = stage.max.count();
  stages_.push_back(message);
}

}  // namespace convexcut::daemon
