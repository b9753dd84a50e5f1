// SPDX-License-Identifier: Apache-2.0
#include "replay/watch.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <string>

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <system_error>
#include <unistd.h>

#include "daemon/dds/participant.hpp"
#include "daemon/dds/qos.hpp"
#include "daemon/dds/ros2_type.hpp"
#include "daemon/dds/topic_name.hpp"
#include "replay/watch_report.hpp"

namespace convexcut::replay {
namespace {

using Clock = std::chrono::steady_clock;
using daemon::Entity;

constexpr std::chrono::seconds kInterval{1};
constexpr unsigned kLinesAHeader = 20;
// Of the readers' histories: what may arrive while a line is printed.
constexpr std::int32_t kCloudDepth = 5;
constexpr std::int32_t kSmallMessageDepth = 500;

class FileDescriptor {
 public:
  FileDescriptor(int fd, const char* what) : fd_(fd) {
    if (fd < 0) throw std::system_error(errno, std::generic_category(), what);
  }
  ~FileDescriptor() { ::close(fd_); }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  [[nodiscard]] int get() const noexcept { return fd_; }

 private:
  int fd_;
};

// SIGINT and SIGTERM as something to poll. Made before DDS starts its threads: they inherit the
// mask, so that none of them takes the signal.
class StopSignal {
 public:
  StopSignal() : fd_(::signalfd(-1, &block(), SFD_CLOEXEC | SFD_NONBLOCK), "signalfd") {}
  ~StopSignal() {
    signalfd_siginfo taken{};  // else it would come once more when it is let through
    while (::read(fd_.get(), &taken, sizeof taken) > 0) {
    }
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
  [[nodiscard]] int fd() const noexcept { return fd_.get(); }

 private:
  const sigset_t& block() {
    ::sigemptyset(&signals_);
    ::sigaddset(&signals_, SIGINT);
    ::sigaddset(&signals_, SIGTERM);
    ::pthread_sigmask(SIG_BLOCK, &signals_, &before_);
    return signals_;
  }
  sigset_t signals_{};
  sigset_t before_{};
  FileDescriptor fd_;
};

// A reader that writes to an eventfd, which outlives it, when data has come.
class Subscription {
 public:
  Subscription(const daemon::Participant& participant, const daemon::Ros2Type& type,
               std::string_view ros_name, std::int32_t depth, FileDescriptor& data_came)
      : name_(daemon::dds_topic_name(ros_name)),
        topic_(daemon::require(dds_create_topic(participant.handle(), type.descriptor,
                                                name_.c_str(), nullptr, nullptr),
                               name_)) {
    dds_listener_t* listener = dds_create_listener(&data_came);
    dds_lset_data_available(listener, [](dds_entity_t, void* argument) {
      ::eventfd_write(static_cast<const FileDescriptor*>(argument)->get(), 1);
    });
    const dds_entity_t reader = dds_create_reader(participant.handle(), topic_.get(),
                                                  daemon::reader_qos(depth, type).get(), listener);
    dds_delete_listener(listener);
    reader_ = daemon::require(reader, name_);
  }

  // Calls use(const T&) for everything that has come.
  template <class T, class Use>
  void take_all(Use use) {
    void* sample = nullptr;
    dds_sample_info_t info;
    while (dds_take(reader_.get(), &sample, &info, 1, 1) == 1) {
      if (info.valid_data) use(*static_cast<const T*>(sample));
      static_cast<void>(dds_return_loan(reader_.get(), &sample, 1));
      sample = nullptr;
    }
  }

  [[nodiscard]] std::uint32_t publishers() const {
    dds_subscription_matched_status_t status{};
    static_cast<void>(dds_get_subscription_matched_status(reader_.get(), &status));
    return status.current_count;
  }

  // "" unless a publisher of the topic offers less than we ask for.
  [[nodiscard]] std::string incompatibility() const {
    dds_requested_incompatible_qos_status_t status{};
    static_cast<void>(dds_get_requested_incompatible_qos_status(reader_.get(), &status));
    if (status.total_count == 0) return "";
    return name_ + " has a publisher with incompatible QoS: " +
           std::string(daemon::policy_name(status.last_policy_id));
  }

 private:
  std::string name_;
  Entity topic_;
  Entity reader_;
};

class Watch {
 public:
  Watch(const WatchOptions& options, std::FILE* out)
      : options_(options),
        out_(out),
        data_came_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK), "eventfd"),
        participant_(options.dds),
        structure_(participant_, daemon::kPointCloud2Type, options.dds.structure_topic, kCloudDepth,
                   data_came_),
        points_(participant_, daemon::kPointCloud2Type, options.dds.points_topic, kCloudDepth,
                data_came_),
        imu_(participant_, daemon::kImuType, options.dds.imu_topic, kSmallMessageDepth, data_came_),
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

  void take_all() {
    using Cloud = sensor_msgs_msg_dds__PointCloud2_;
    structure_.take_all<Cloud>([this](const Cloud&) { counter_.add_structure(); });
    points_.take_all<Cloud>([this](const Cloud&) { counter_.add_points(); });
    imu_.take_all<sensor_msgs_msg_dds__Imu_>([this](const auto&) { counter_.add_imu(); });
    status_.take_all<convexcut_msg_dds__ScanStatus_>(
        [this](const auto& status) { counter_.add_status(status); });
  }

  void report(const WatchInterval& interval) {
    const std::uint32_t publishers =
        structure_.publishers() + points_.publishers() + imu_.publishers() + status_.publishers();
    say_what_is_wrong(publishers);
    if (options_.json) {
      print(watch_json(interval, publishers));
    } else if (counter_.anything_came() || publishers > 0) {
      const bool terminal = ::isatty(::fileno(out_)) != 0;
      if (lines_ == 0 || (terminal && lines_ % kLinesAHeader == 0)) print(watch_header());
      print(watch_line(interval));
      ++lines_;
    }
  }

  void print(const std::string& text) {
    if (std::fputs(text.c_str(), out_) < 0 || std::fflush(out_) != 0) {
      throw std::system_error(errno, std::generic_category(), "cannot write the output");
    }
  }

  // Once each time that the publishers are gone.
  void say_what_is_wrong(std::uint32_t publishers) {
    lonely_ = publishers > 0 ? std::chrono::seconds{0} : lonely_ + kInterval;
    if (publishers > 0) said_ = false;
    if (lonely_ < options_.patience || publishers > 0 || said_) return;
    said_ = true;
    std::string message = "no convexcut on DDS domain " + std::to_string(participant_.domain()) +
                          ": check that the daemon runs, its dds.domain and topic names, and that "
                          "the firewall lets DDS's UDP ports and multicast pass";
    for (const Subscription* topic : {&structure_, &points_, &imu_, &status_}) {
      const std::string found = topic->incompatibility();
      if (!found.empty()) message += "; " + found;
    }
    static_cast<void>(std::fprintf(stderr, "%s\n", message.c_str()));
  }

  WatchOptions options_;
  std::FILE* out_;
  StopSignal stop_;  // above participant_: the signals are blocked before DDS has threads
  FileDescriptor data_came_;
  daemon::Participant participant_;
  Subscription structure_;
  Subscription points_;
  Subscription imu_;
  Subscription status_;
  WatchCounter counter_;
  unsigned lines_ = 0;
  std::chrono::seconds lonely_{0};
  bool said_ = false;
};

}  // namespace

int watch(const WatchOptions& options, std::FILE* out) { return Watch(options, out).run(); }

}  // namespace convexcut::replay
