// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "drivers/live/file_descriptor.hpp"
#include "drivers/live/host_clock.hpp"
#include "replay/emulator/emulated_imu.hpp"
#include "replay/feed/datagram_link.hpp"
#include "replay/feed/faults.hpp"
#include "replay/feed/feed.hpp"

namespace convexcut::replay {

struct PlayerOptions {
  double rate = 1.0;        // recorded seconds per second; 0: as fast as possible
  std::uint64_t times = 1;  // that the recording is played; 0: until a signal
  Duration from{};          // of the recording, from its first record
  Duration to = Duration::max();
  Duration wait{};  // for a program that opens the IMU, before the start
  Faults faults{};  // the player sees to the stalls
  std::optional<Duration> unplug_imu = std::nullopt;  // after this time
  Duration unplugged_for = std::chrono::seconds{2};
};

// Plays recorded sensors side by side. What is played again is the time of the first of them, the
// lidar where there is one: its last packet and its first are then a packet's time apart. A record
// is due at start + recorded time ÷ rate, whatever happened before: lateness does not add up.
// Between records the emulated IMU answers its host. One thread.
class Player {
 public:
  using Time = live::Steady::time_point;

  // SIGINT and SIGTERM must be blocked in every thread; they end the playing. `link` and `imu` may
  // be null.
  Player(const PlayerOptions& options, const std::vector<Feed*>& feeds, DatagramLink* link,
         EmulatedImu* imu);

  // `progress` is called with every record. Throws what the feeds throw.
  void run(const std::function<void()>& progress);

  [[nodiscard]] bool stopped() const noexcept { return stopped_; }  // by a signal
  [[nodiscard]] std::uint64_t loops() const noexcept { return played_.loop; }
  [[nodiscard]] std::uint64_t stalled() const noexcept { return stalled_; }
  [[nodiscard]] Duration elapsed() const noexcept { return live::Steady::now() - start_; }
  // By how much the latest record was sent after it was due.
  [[nodiscard]] Duration max_lateness() const noexcept { return max_lateness_; }

 private:
  struct Part {
    Feed* feed = nullptr;
    HostTime first = HostTime::max();  // of what was played
    HostTime latest = HostTime::min();
  };

  [[nodiscard]] Part* next_part();
  void play_once(const std::function<void()>& progress);
  void send(Feed& feed, Duration recorded);
  [[nodiscard]] bool played_nothing() const;
  [[nodiscard]] bool ends_before(HostTime stamp) const;
  void find_loop();
  [[nodiscard]] bool paced() const noexcept { return options_.rate > 0; }
  void wait_for_listener();
  void leave_time_to_read();
  // Until `due`, or a signal; serves link and IMU meanwhile.
  void wait_until(Time due);
  void serve(Time now);
  void look_for_signal();
  void sleep_until(Time due);

  PlayerOptions options_;
  std::vector<Part> parts_;
  DatagramLink* link_;
  EmulatedImu* imu_;
  live::FileDescriptor signals_;
  HostTime first_{};
  HostTime loop_begin_ = HostTime::min();
  HostTime loop_end_ = HostTime::max();
  PlayedTime played_;
  Time start_{};
  bool unplugged_ = false;
  bool stopped_ = false;
  std::uint64_t stalled_ = 0;
  Duration max_lateness_{};
};

}  // namespace convexcut::replay
