// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "drivers/xsens/mtdata2.hpp"
#include "replay/emulator/emulated_imu.hpp"
#include "replay/feed/faults.hpp"
#include "replay/feed/feed.hpp"
#include "replay/feed/imu_messages.hpp"

namespace convexcut::replay {

struct ImuFeedOptions {
  std::filesystem::path file;
  HostTime unstamped_start{};  // of a raw .bin stream
  bool wait_for_line = false;  // rather than to lose a message when the host is slow to read
};

// A recorded serial IMU: its messages, with the counters and times in them as PlayedTime has it.
// They come out of an emulated device, and so only while it measures and somebody listens.
class ImuFeed final : public Feed {
 public:
  // Throws capture::CaptureError.
  ImuFeed(ImuFeedOptions options, EmulatedImu& device, const Faults& faults, std::uint64_t seed);

  [[nodiscard]] std::optional<HostTime> next_stamp() override;
  void send(const PlayedTime& time) override;
  void skip() override { messages_->pop(); }
  void rewind() override;
  [[nodiscard]] Duration record_interval() const noexcept override { return interval_; }

  [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }
  [[nodiscard]] std::uint64_t garbage() const noexcept { return garbage_; }
  // Messages that nobody took: unplugged, being configured, not opened, not read in time.
  [[nodiscard]] std::uint64_t unheard() const noexcept { return unheard_; }

 private:
  // The data of the items of a message that say when; empty: it has none of the kind.
  struct TimeItems {
    wire::WritableBytes counter;
    wire::WritableBytes fine;
    wire::WritableBytes coarse;
    void take(const xsens::RawItem& item, wire::WritableBytes data);
  };

  // Moves counter and time of a measurement message and seals it again; false for one that is not
  // after the last one of the loop before.
  [[nodiscard]] bool move_time(std::vector<std::byte>& frame, const PlayedTime& time);
  void move_counter(wire::WritableBytes counter);
  [[nodiscard]] bool move_ticks(const TimeItems& items, const PlayedTime& time);
  void note_interval(ImuTime time);
  [[nodiscard]] bool put_on_line(wire::Bytes frame);

  ImuFeedOptions options_;
  EmulatedImu& device_;
  Faults faults_;
  Dice dice_;
  std::unique_ptr<ImuMessages> messages_;
  xsens::SampleClock clock_ = xsens::SampleClock::sample_time_fine();
  std::optional<ImuTime> first_time_;
  std::optional<ImuTime> newest_time_;   // of this loop, as recorded
  std::optional<Duration> newest_sent_;  // of all, since the first
  Duration interval_{};                  // the least between messages, by the device's clock
  std::uint16_t counter_shift_ = 0;
  std::optional<std::uint16_t> newest_counter_;  // as it was sent
  bool first_of_loop_ = true;
  std::uint64_t sent_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t garbage_ = 0;
  std::uint64_t unheard_ = 0;
};

}  // namespace convexcut::replay
