// SPDX-License-Identifier: Apache-2.0
#include "replay/watch.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <string>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <system_error>
#include <unistd.h>

#include "daemon/dds/health_message.hpp"
#include "replay/health_report.hpp"
#include "replay/stop_signal.hpp"
#include "replay/subscription.hpp"
#include "replay/watch_report.hpp"

namespace convexcut::replay {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kInterval{1};
constexpr unsigned kLinesAHeader = 20;
// Of the readers' histories: what may arrive while a line is printed.
constexpr std::int32_t kCloudDepth = 5;
constexpr std::int32_t kSmallMessageDepth = 500;

class Watch {
 public:
  Watch(const WatchOptions& options, std::FILE* out)
      : options_(options),
        out_(out),
        data_came_(require_descriptor(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK), "eventfd")),
        participant_(options.dds),
        structure_(participant_, daemon::kPointCloud2Type, options.dds.structure_topic, kCloudDepth,
                   data_came_),
        points_(participant_, daemon::kPointCloud2Type, options.dds.points_topic, kCloudDepth,
                data_came_),
        imu_(participant_, daemon::kImuType, options.dds.imu_topic, kSmallMessageDepth, data_came_),
        health_(participant_, daemon::kHealthType, daemon::kHealthTopic, kSmallMessageDepth,
                data_came_),
        status_(participant_, daemon::kScanStatusType, daemon::kStatusTopic, kSmallMessageDepth,
                data_came_) {}

  int run() {
    const Clock::time_point start = Clock::now();
    Clock::time_point interval_start = start;
    bool stopped = false;
    while (!stopped) {
      stopped = wait_until(interval_start + kInterval);
      take_all();
      const Clock::time_point now = Clock::now();
      stopped = stopped || (options_.duration && now - start >= *options_.duration);
      if (!stopped && now - interval_start < kInterval) continue;
      report(counter_.finish(now - interval_start));
      interval_start = now;
    }
    if (!options_.json && counter_.health()) print(health_block(*counter_.health()));
    return counter_.anything_came() ? 0 : 1;
  }

 private:
  // Returns when data came or the time has; true when a signal asks to stop.
  bool wait_until(Clock::time_point until) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
    std::array<pollfd, 2> ready{{{stop_.fd(), POLLIN, 0}, {data_came_.get(), POLLIN, 0}}};
    ::poll(ready.data(), ready.size(), static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    eventfd_t count = 0;
    ::eventfd_read(data_came_.get(), &count);
    return (ready[0].revents & POLLIN) != 0;
  }

  [[nodiscard]] std::array<const Subscription*, 5> topics() const {
    return {&structure_, &points_, &imu_, &health_, &status_};
  }
  [[nodiscard]] std::uint32_t publishers() const {
    std::uint32_t count = 0;
    for (const Subscription* topic : topics()) count += topic->publishers();
    return count;
  }

  void take_all() {
    using Cloud = sensor_msgs_msg_dds__PointCloud2_;
    structure_.take_all<Cloud>([this](const Cloud&) { counter_.add_structure(); });
    points_.take_all<Cloud>([this](const Cloud&) { counter_.add_points(); });
    imu_.take_all<sensor_msgs_msg_dds__Imu_>([this](const auto&) { counter_.add_imu(); });
    status_.take_all<convexcut_msg_dds__ScanStatus_>(
        [this](const auto& status) { counter_.add_status(status); });
    health_.take_all<convexcut_msg_dds__Health_>(
        [this](const auto& health) { counter_.set_health(daemon::snapshot_of(health)); });
  }

  void report(const WatchInterval& interval) {
    const std::uint32_t publisher_count = publishers();
    if (publisher_count > 0) {
      say_it_is_there();
    } else {
      say_it_is_not_there();
    }
    if (options_.json) {
      print(watch_json(interval, publisher_count));
    } else if (publisher_count > 0 || interval.anything_came()) {
      print_lines(interval);
    }
  }

  void print_lines(const WatchInterval& interval) {
    const bool terminal = ::isatty(::fileno(out_)) != 0;
    const bool page = terminal && lines_ > 0 && lines_ % kLinesAHeader == 0;
    if (interval.health && (page || states_.changed(*interval.health))) {
      print(health_block(*interval.health));
      header_due_ = true;
    }
    if (page || std::exchange(header_due_, false)) print(watch_header());
    print(watch_line(interval));
    ++lines_;
  }

  void print(const std::string& text) {
    if (std::fputs(text.c_str(), out_) < 0 || std::fflush(out_) != 0) {
      throw std::system_error(errno, std::generic_category(), "cannot write the output");
    }
  }

  void say_it_is_there() {
    if (seen_ && said_) say("convexcut on DDS domain " + domain() + " is back");
    seen_ = true;
    said_ = false;
    lonely_ = std::chrono::seconds{0};
  }

  // Once each time that the publishers are gone.
  void say_it_is_not_there() {
    lonely_ += kInterval;
    if (said_ || (!seen_ && lonely_ < options_.patience)) return;
    said_ = true;
    if (seen_) {
      if (!options_.json && counter_.health()) print(health_block(*counter_.health()));
      counter_.forget_health();
      return say("convexcut on DDS domain " + domain() +
                 " went away: the daemon ended, or the network to it is interrupted; waiting for "
                 "it to come back");
    }
    std::string message = "no convexcut on DDS domain " + domain() +
                          ": check that the daemon runs, its dds.domain and topic names, and that "
                          "the firewall lets DDS's UDP ports and multicast pass";
    for (const Subscription* topic : topics()) {
      const std::string found = topic->incompatibility();
      if (!found.empty()) message += "; " + found;
    }
    say(message);
  }

  static void say(const std::string& line) {
    static_cast<void>(std::fprintf(stderr, "%s\n", line.c_str()));
  }
  [[nodiscard]] std::string domain() const { return std::to_string(participant_.domain()); }

  WatchOptions options_;
  std::FILE* out_;
  StopSignal stop_;  // above participant_: the signals are blocked before DDS has threads
  live::FileDescriptor data_came_;
  daemon::Participant participant_;
  Subscription structure_;
  Subscription points_;
  Subscription imu_;
  Subscription health_;
  Subscription status_;
  WatchCounter counter_;
  HealthStates states_;
  unsigned lines_ = 0;
  bool header_due_ = true;
  std::chrono::seconds lonely_{0};
  bool seen_ = false;  // a publisher, at some time
  bool said_ = false;  // that there is none
};

}  // namespace

int watch(const WatchOptions& options, std::FILE* out) { return Watch(options, out).run(); }

}  // namespace convexcut::replay
