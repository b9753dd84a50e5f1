// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "drivers/can/xsens_can.hpp"
#include "drivers/live/file_descriptor.hpp"
#include "drivers/recording/can_frames.hpp"
#include "replay/feed/faults.hpp"
#include "replay/feed/feed.hpp"

namespace convexcut::replay {

struct CanFeedOptions {
  std::filesystem::path file;
  std::string interface;
  can::XsensCanIds ids{};  // of the messages that hold counters and times
};

// A recorded CAN bus: its frames onto an interface, with SampleTime and GroupCounter as PlayedTime
// has it. Error frames, which are a controller's and not the bus's, are not sent.
class CanFeed final : public Feed {
 public:
  // Throws capture::CaptureError, and std::runtime_error when the interface cannot be sent to.
  CanFeed(CanFeedOptions options, const Faults& faults, std::uint64_t seed);

  [[nodiscard]] std::optional<HostTime> next_stamp() override;
  void send(const PlayedTime& time) override;
  void skip() override { have_frame_ = false; }
  void rewind() override;
  [[nodiscard]] Duration record_interval() const noexcept override { return {}; }

  [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }
  [[nodiscard]] std::uint64_t not_sent() const noexcept { return not_sent_; }

 private:
  void open_socket();
  void move_time(const PlayedTime& time);
  void move_counter();
  void transmit();

  CanFeedOptions options_;
  Faults faults_;
  Dice dice_;
  live::FileDescriptor socket_;
  std::unique_ptr<recording::CanFrames> frames_;
  can::CanFrame frame_;
  bool have_frame_ = false;
  std::optional<std::uint32_t> first_us_;  // SampleTime as recorded
  std::optional<std::uint32_t> newest_us_;
  Duration gained_{};  // by the device's clock since its first frame
  bool first_of_loop_ = true;
  std::uint16_t counter_shift_ = 0;
  std::optional<std::uint16_t> newest_counter_;  // as it was sent
  std::uint64_t sent_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t not_sent_ = 0;
};

}  // namespace convexcut::replay
