// SPDX-License-Identifier: Apache-2.0
#include "daemon/health/prometheus.hpp"

#include <array>
#include <charconv>

namespace convexcut::daemon {
namespace {

double seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

std::string number(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

// name="value" with the value's backslashes, quotes and newlines escaped.
std::string label(std::string_view name, std::string_view value) {
  std::string text = std::string(name) + "=\"";
  for (const char c : value) {
    if (c == '\n') {
      text += "\\n";
      continue;
    }
    if (c == '\\' || c == '"') text += '\\';
    text += c;
  }
  return text + '"';
}

class Exposition {
 public:
  // Begins a metric: its samples follow directly.
  void metric(std::string_view name, std::string_view type, std::string_view help) {
    name_ = "convexcut_" + std::string(name);
    text_.append("# HELP ").append(name_).append(" ").append(help).append("\n");
    text_.append("# TYPE ").append(name_).append(" ").append(type).append("\n");
  }
  // `suffix`: _sum and _count of a summary.
  void sample(std::string_view labels, const std::string& value, std::string_view suffix = "") {
    text_.append(name_).append(suffix);
    if (!labels.empty()) text_.append("{").append(labels).append("}");
    text_.append(" ").append(value).append("\n");
  }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  std::string name_;
  std::string text_;
};

template <class State>
void add_states(Exposition& out, const std::string& labels, State now, int states) {
  for (int i = 0; i < states; ++i) {
    const auto state = static_cast<State>(i);
    out.sample(labels + label("state", name_of(state)), state == now ? "1" : "0");
  }
}

void add_daemon(Exposition& out, const HealthSnapshot& snapshot) {
  out.metric("state", "gauge", "State of the daemon: 1 for the state it is in");
  add_states(out, "", snapshot.state, kDaemonStates);
  out.metric("uptime_seconds", "gauge", "Time since the daemon started");
  out.sample("", number(seconds(snapshot.uptime)));
}

void add_source_counter(Exposition& out, const HealthSnapshot& snapshot,
                        std::uint64_t SourceReading::*value, std::string_view name,
                        std::string_view help) {
  out.metric(name, "counter", help);
  for (const SourceHealth& source : snapshot.sources) {
    out.sample(label("source", source.name), std::to_string(source.reading.*value));
  }
}

void add_sources(Exposition& out, const HealthSnapshot& snapshot) {
  if (snapshot.sources.empty()) return;
  out.metric("source_state", "gauge", "State of a source: 1 for the state it is in");
  for (const SourceHealth& source : snapshot.sources) {
    add_states(out, label("source", source.name) + ",", source.state, kSourceStates);
  }
  out.metric("source_silence_seconds", "gauge", "Time since the last valid input of a source");
  for (const SourceHealth& source : snapshot.sources) {
    out.sample(label("source", source.name),
               source.since_valid ? number(seconds(*source.since_valid)) : "+Inf");
  }
  add_source_counter(out, snapshot, &SourceReading::valid, "source_valid_total",
                     "Packets, messages or samples that were understood");
  add_source_counter(out, snapshot, &SourceReading::invalid, "source_invalid_total",
                     "Input that was not understood");
  add_source_counter(out, snapshot, &SourceReading::lost, "source_lost_total",
                     "Packets or samples that never came");
}

void add_clocks(Exposition& out, const HealthSnapshot& snapshot) {
  if (snapshot.clocks.empty()) return;
  const auto gauge = [&](std::string_view name, std::string_view help, auto value) {
    out.metric(name, "gauge", help);
    for (const SensorClock& clock : snapshot.clocks) {
      out.sample(label("source", clock.name), number(value(clock.health)));
    }
  };
  out.metric("clock_source", "gauge", "Where a sensor's time comes from: 1 for the source in use");
  for (const SensorClock& clock : snapshot.clocks) {
    for (const TimeSource source :
         {TimeSource::none, TimeSource::arrival, TimeSource::envelope, TimeSource::pps}) {
      out.sample(label("source", clock.name) + "," + label("time", name_of(source)),
                 source == clock.health.source ? "1" : "0");
    }
  }
  gauge("clock_offset_seconds", "The host's clock minus the sensor's",
        [](const ClockHealth& clock) { return seconds(clock.offset); });
  gauge("clock_jitter_seconds", "Root mean square of the arrival delays above their lower envelope",
        [](const ClockHealth& clock) { return seconds(clock.jitter); });
  gauge("clock_skew_ratio", "By which the host's clock runs faster than the sensor's",
        [](const ClockHealth& clock) { return clock.skew_ppm / 1e6; });
  out.metric("clock_steps_total", "counter", "Steps of the sensor's or the host's clock");
  for (const SensorClock& clock : snapshot.clocks) {
    out.sample(label("source", clock.name), std::to_string(clock.health.steps));
  }
}

void add_stages(Exposition& out, const HealthSnapshot& snapshot) {
  out.metric("stage_seconds", "summary", "Time through a stage, since the daemon started");
  for (const StageInfo& info : kStages) {
    const StageSummary& stage = snapshot.stages[static_cast<std::size_t>(info.stage)];
    const std::string name = label("stage", info.name);
    const auto quantile = [&](std::string_view q, Duration value) {
      out.sample(name + "," + label("quantile", q),
                 stage.count == 0 ? "NaN" : number(seconds(value)));
    };
    quantile("0.5", stage.p50);
    quantile("0.99", stage.p99);
    quantile("0.999", stage.p999);
    out.sample(name, number(seconds(stage.total)), "_sum");
    out.sample(name, std::to_string(stage.count), "_count");
  }
  out.metric("stage_max_seconds", "gauge", "Longest time through a stage since the daemon started");
  for (const StageInfo& info : kStages) {
    out.sample(label("stage", info.name),
               number(seconds(snapshot.stages[static_cast<std::size_t>(info.stage)].max)));
  }
}

}  // namespace

std::string prometheus_text(const HealthSnapshot& snapshot) {
  Exposition out;
  add_daemon(out, snapshot);
  add_sources(out, snapshot);
  add_clocks(out, snapshot);
  add_stages(out, snapshot);
  for (const CounterInfo& counter : kHealthCounters) {
    out.metric(std::string(counter.name) + "_total", "counter", counter.help);
    out.sample("", std::to_string(snapshot.totals.*counter.value));
  }
  return out.take();
}

}  // namespace convexcut::daemon
