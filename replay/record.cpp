// SPDX-License-Identifier: Apache-2.0
#include "replay/record.hpp"

#include <array>
#include <atomic>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <poll.h>
#include <unistd.h>

#include "daemon/health/source_health.hpp"
#include "daemon/sources/live_health.hpp"
#include "daemon/sources/live_sources.hpp"
#include "daemon/sources/null_sink.hpp"
#include "daemon/sources/recording_setup.hpp"
#include "drivers/recorder/recorder.hpp"
#include "replay/stop_signal.hpp"
#include "replay/text.hpp"

namespace convexcut::replay {
namespace {

using Clock = std::chrono::steady_clock;
using daemon::LiveSources;
using daemon::SourceHealth;
using daemon::SourceMonitor;

// How often the sources are looked at; how long a receive thread waits before it looks at the stop.
constexpr std::chrono::milliseconds kTick{50};
constexpr std::chrono::seconds kShow{1};

// Without a lidar's orientation to compute with, none is needed.
config::Config for_recording(config::Config config) {
  config.mount.orientation = config::MountOrientation::fixed;
  return config;
}

class Recording {
 public:
  explicit Recording(const RecordOptions& options)
      : options_(options),
        config_(for_recording(options.config)),
        terminal_(::isatty(STDERR_FILENO) != 0),
        recorder_(daemon::recorder_options(config_.record),
                  [this](bool, const std::string& line) { say(line); }),
        sources_(std::make_unique<LiveSources>(config_, returns_, samples_, angles_,
                                               daemon::taps_of(recorder_))) {
    for (const LiveSources::Entry& entry : sources_->entries()) {
      monitors_.emplace_back(std::string(entry.name), true);
    }
  }
  ~Recording() { join(); }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  void run() {
    start_ = Clock::now();
    for (const LiveSources::Entry& entry : sources_->entries()) {
      threads_.emplace_back([this, &entry] {
        // Relaxed: the flag only ends the loop, it publishes nothing.
        while (!stop_.load(std::memory_order_relaxed)) entry.source.receive(kTick);
      });
    }
    for (Clock::time_point show = start_; !pause();) {
      const Clock::time_point now = Clock::now();
      update(now);
      if (options_.duration && now - start_ >= *options_.duration) break;
      if (now < show) continue;
      show = now + kShow;
      show_progress(now);
    }
    update(Clock::now());
    join();
    recorder_.finish();
    if (terminal_) std::fputs("\r\033[K", stderr);
  }

  [[nodiscard]] int report() const {
    options_.json ? report_json() : report_text();
    if (recorder_.counters().records.value() == 0) {
      std::string why = "nothing was recorded";
      for (const std::string& warning : sources_->warnings()) why += "; " + warning;
      std::fprintf(stderr, "convexcut record: %s\n", why.c_str());
      return 1;
    }
    return recorder_.missing() > 0 ? 1 : 0;
  }

 private:
  void join() {
    stop_.store(true, std::memory_order_relaxed);  // pairs with the load in run()
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

  // True when a signal asks to stop.
  [[nodiscard]] bool pause() const {
    pollfd poll{signal_.fd(), POLLIN, 0};
    return ::poll(&poll, 1, static_cast<int>(kTick.count())) > 0;
  }

  void update(Clock::time_point now) {
    for (std::size_t i = 0; i < monitors_.size(); ++i) {
      const LiveSources::Entry& entry = sources_->entries()[i];
      const daemon::SourceState before = monitors_[i].health().state;
      const SourceHealth& health = monitors_[i].update(daemon::reading_of(*sources_, entry), now);
      if (!terminal_ && health.state != before) {
        say(health.name + " (" + entry.device + ") is " + std::string(name_of(health.state)));
      }
    }
  }

  void say(const std::string& line) const {
    std::fprintf(stderr, "%s%s\n", terminal_ ? "\r\033[K" : "", line.c_str());
  }

  void show_progress(Clock::time_point now) const {
    if (!terminal_) return;
    std::string line = format("%.0f s", seconds(now - start_));
    for (const SourceMonitor& monitor : monitors_) {
      const SourceHealth& health = monitor.health();
      line += " | " + health.name + " " + std::string(name_of(health.state)) +
              format(" %.0f Hz", health.valid_hz);
    }
    line += format(" | %.1f MB", megabytes());
    if (!recorder_.is_recording()) line += ", stopped";
    if (recorder_.missing() > 0) line += ", " + grouped(recorder_.missing()) + " missing";
    std::fprintf(stderr, "\r\033[K%s", line.c_str());
  }

  [[nodiscard]] double megabytes() const {
    return static_cast<double>(recorder_.counters().bytes.value()) * 1e-6;
  }

  void report_text() const {
    for (std::size_t i = 0; i < monitors_.size(); ++i) {
      const SourceHealth& health = monitors_[i].health();
      std::printf("%-12s %s valid, %s invalid, %s lost, from %s\n", health.name.c_str(),
                  grouped(health.reading.valid).c_str(), grouped(health.reading.invalid).c_str(),
                  grouped(health.reading.lost).c_str(), sources_->entries()[i].device.c_str());
    }
    std::printf("recorded     %s records, %.1f MB, in %s\n",
                grouped(recorder_.counters().records.value()).c_str(), megabytes(),
                config_.record.directory.c_str());
    if (recorder_.missing() > 0) {
      std::printf("missing      %s records\n", grouped(recorder_.missing()).c_str());
    }
  }

  void report_json() const {
    JsonObject summary;
    for (const SourceMonitor& monitor : monitors_) {
      const SourceHealth& health = monitor.health();
      JsonObject source;
      source.add("valid", health.reading.valid)
          .add("invalid", health.reading.invalid)
          .add("lost", health.reading.lost);
      summary.add(health.name, source);
    }
    summary.add("records", recorder_.counters().records.value())
        .add("bytes", recorder_.counters().bytes.value())
        .add("missing", recorder_.missing())
        .add("directory", config_.record.directory);
    std::puts(summary.text().c_str());
  }

  const RecordOptions& options_;
  config::Config config_;
  bool terminal_;
  StopSignal signal_;  // above what has threads
  daemon::NullSink<ReturnBatch> returns_;
  daemon::NullSink<ImuSample> samples_;
  daemon::NullSink<EncoderSample> angles_;
  recorder::Recorder recorder_;
  std::unique_ptr<LiveSources> sources_;
  std::vector<SourceMonitor> monitors_;  // in the order of the sources' entries
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
  Clock::time_point start_{};
};

}  // namespace

int record(const RecordOptions& options) {
  Recording recording(options);
  recording.run();
  return recording.report();
}

}  // namespace convexcut::replay
