// SPDX-License-Identifier: Apache-2.0
#include "replay/replay.hpp"

#include <csignal>
#include <cstdio>
#include <memory>
#include <vector>

#include "replay/feed/can_feed.hpp"
#include "replay/feed/imu_feed.hpp"
#include "replay/feed/lidar_feed.hpp"
#include "replay/progress_bar.hpp"
#include "replay/text.hpp"

namespace convexcut::replay {
namespace {

// Different streams of one seed: a fault of one sensor does not change those of another.
enum Stream : std::uint64_t { kLidarFaults = 0x1, kImuFaults = 0x10000, kCanFaults = 0x20000 };

void block_stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

MtiOptions device_options(const config::Imu& imu) {
  MtiOptions options;
  if (imu.baud != 0) options.baud = imu.baud;
  return options;
}

class Run {
 public:
  explicit Run(const ReplayOptions& options) : options_(options) {
    block_stop_signals();
    open_lidar();
    open_imu();
    open_can();
    std::vector<Feed*> feeds;
    for (Feed* feed : std::initializer_list<Feed*>{lidar_.get(), imu_.get(), can_.get()}) {
      if (feed != nullptr) feeds.push_back(feed);
    }
    player_ = std::make_unique<Player>(options.player, feeds, link_.get(), device_.get());
  }

  void play() {
    if (device_ && !options_.json) {
      std::printf("imu          %s\n", device_->terminal().path().c_str());
      std::fflush(stdout);
    }
    ProgressBar bar("replay");
    player_->run([&] {
      if (lidar_) {
        bar.update(lidar_->bytes_read(), lidar_->bytes_total(),
                   format("%.1f s", seconds(player_->elapsed())));
      }
    });
    elapsed_ = player_->elapsed();
  }

  void report() const { options_.json ? report_json() : report_text(); }

 private:
  void open_lidar();
  void open_imu();
  void open_can();
  void report_text() const;
  void report_faults() const;
  void report_json() const;

  const ReplayOptions& options_;
  std::unique_ptr<DatagramLink> link_;
  std::unique_ptr<LidarFeed> lidar_;
  std::unique_ptr<EmulatedImu> device_;
  std::unique_ptr<ImuFeed> imu_;
  std::unique_ptr<CanFeed> can_;
  std::unique_ptr<Player> player_;
  HostTime lidar_start_{};
  Duration elapsed_{};
};

void Run::open_lidar() {
  if (options_.recordings.lidar.empty()) return;
  const auto chosen = [](std::uint16_t port, std::uint16_t usual) {
    return port != 0 ? port : usual;
  };
  link_ = std::make_unique<DatagramLink>(options_.to_address, options_.player.faults,
                                         options_.seed + kLidarFaults);
  lidar_ = std::make_unique<LidarFeed>(
      LidarFeedOptions{options_.recordings.lidar,
                       chosen(options_.data_port, options_.config.lidar.data_port),
                       chosen(options_.position_port, options_.config.lidar.position_port)},
      *link_);
  const auto start = lidar_->next_stamp();
  if (!start) {
    throw std::runtime_error(options_.recordings.lidar.string() +
                             ": no lidar packets: expected UDP datagrams of 1206 or 512 bytes");
  }
  lidar_start_ = *start;
}

void Run::open_imu() {
  if (options_.recordings.imu.empty()) return;
  device_ = std::make_unique<EmulatedImu>(options_.imu_link, device_options(options_.config.imu));
  ImuFeedOptions feed;
  feed.file = options_.recordings.imu;
  feed.unstamped_start = lidar_start_ + options_.recordings.imu_start;
  feed.wait_for_line = options_.player.rate == 0;
  imu_ =
      std::make_unique<ImuFeed>(feed, *device_, options_.player.faults, options_.seed + kImuFaults);
  if (!imu_->next_stamp()) {
    throw std::runtime_error(options_.recordings.imu.string() +
                             ": no measurements: expected MTData2 messages of an Xsens MTi");
  }
}

void Run::open_can() {
  if (options_.recordings.can.empty()) return;
  can_ =
      std::make_unique<CanFeed>(CanFeedOptions{options_.recordings.can, options_.can_interface,
                                               daemon::can_driver_options(options_.config.can).ids},
                                options_.player.faults, options_.seed + kCanFaults);
}

void Run::report_text() const {
  if (lidar_) {
    std::printf("lidar        %s data and %s position packets, %s datagrams sent to %s\n",
                grouped(lidar_->data_packets()).c_str(),
                grouped(lidar_->position_packets()).c_str(), grouped(link_->counts().sent).c_str(),
                options_.to_address.c_str());
  }
  if (imu_) {
    std::printf(
        "imu          %s messages sent, %s not heard (terminal not open, or being "
        "configured)\n",
        grouped(imu_->sent()).c_str(), grouped(imu_->unheard()).c_str());
  }
  if (can_) {
    std::printf("can          %s frames sent to %s, %s not taken\n", grouped(can_->sent()).c_str(),
                options_.can_interface.c_str(), grouped(can_->not_sent()).c_str());
  }
  report_faults();
  std::printf("time         %.3f s, played %s times, latest record %.3f ms after its time%s\n",
              seconds(elapsed_), grouped(player_->loops() + 1).c_str(),
              seconds(player_->max_lateness()) * 1e3,
              player_->stopped() ? "; ended by a signal" : "");
}

void Run::report_faults() const {
  if (link_) {
    const DatagramCounts& n = link_->counts();
    if (n.lost + n.duplicated + n.reordered + n.garbage + n.not_sent > 0) {
      std::printf(
          "faults       lidar: %s lost, %s duplicated, %s reordered, %s garbage, %s refused "
          "by the network\n",
          grouped(n.lost).c_str(), grouped(n.duplicated).c_str(), grouped(n.reordered).c_str(),
          grouped(n.garbage).c_str(), grouped(n.not_sent).c_str());
    }
  }
  if (imu_ && imu_->lost() + imu_->garbage() > 0) {
    std::printf("faults       imu: %s lost, %s garbage\n", grouped(imu_->lost()).c_str(),
                grouped(imu_->garbage()).c_str());
  }
  if (player_->stalled() > 0) {
    std::printf("faults       %s records fell into a stall\n", grouped(player_->stalled()).c_str());
  }
}

void Run::report_json() const {
  JsonObject summary;
  if (lidar_) {
    const DatagramCounts& n = link_->counts();
    summary.add("data_packets", lidar_->data_packets())
        .add("position_packets", lidar_->position_packets())
        .add("foreign_datagrams", lidar_->foreign())
        .add("datagrams_sent", n.sent)
        .add("datagrams_lost", n.lost)
        .add("datagrams_duplicated", n.duplicated)
        .add("datagrams_reordered", n.reordered)
        .add("datagrams_garbage", n.garbage)
        .add("datagrams_refused", n.not_sent);
  }
  if (imu_) {
    summary.add("imu_sent", imu_->sent())
        .add("imu_unheard", imu_->unheard())
        .add("imu_lost", imu_->lost())
        .add("imu_garbage", imu_->garbage());
  }
  if (can_) {
    summary.add("can_sent", can_->sent())
        .add("can_lost", can_->lost())
        .add("can_not_taken", can_->not_sent());
  }
  summary.add("stalled", player_->stalled())
      .add("times", player_->loops() + 1)
      .add("elapsed_s", seconds(elapsed_), 6)
      .add("max_lateness_ms", seconds(player_->max_lateness()) * 1e3, 3)
      .add("stopped", player_->stopped());
  std::puts(summary.text().c_str());
}

}  // namespace

void replay(const ReplayOptions& options) {
  Run run(options);
  run.play();
  run.report();
}

}  // namespace convexcut::replay
