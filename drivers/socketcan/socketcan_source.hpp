// SPDX-License-Identifier: Apache-2.0
//
// A CAN interface of this host (SocketCAN: can.rst of the Linux kernel) on its way into the drivers
// of what is on the bus.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <linux/can.h>
#include <sys/socket.h>

#include "core/counter.hpp"
#include "drivers/can/can_frame.hpp"
#include "drivers/can/controller_state.hpp"
#include "drivers/can/frame_receiver.hpp"
#include "drivers/can/socketcan_layout.hpp"
#include "drivers/live/ancillary.hpp"
#include "drivers/live/drop_count.hpp"
#include "drivers/live/file_descriptor.hpp"
#include "drivers/live/host_clock.hpp"
#include "drivers/live/link_status.hpp"
#include "drivers/live/live_source.hpp"
#include "drivers/live/raw_tap.hpp"
#include "drivers/live/retry_pause.hpp"

namespace convexcut::socketcan {

struct SocketCanOptions {
  std::string interface;        // "can0"
  std::vector<can::CanId> ids;  // what is received, and nothing else but error frames
  // After so long without a frame the receiver is flushed.
  Duration idle = std::chrono::milliseconds{20};
};

struct SocketCanCounters {
  Counter open_attempts;
  Counter opened;
  Counter closed;     // an open link was lost: interface down or gone
  Counter frames;     // handed to the receiver, error frames among them
  Counter malformed;  // no CAN frame, or truncated
  Counter dropped;    // by the kernel, the socket's buffer being full
  Counter error_frames;
  Counter controller_overflows;  // reported: the controller lost frames before the kernel saw them
  Counter error_passive;         // times the controller became so
  Counter bus_off;               // times the controller went off the bus
  Counter restarts;              // reported after bus-off
};

// While bus-off is reported the link is LinkState::error, and the socket stays open: the kernel
// (restart-ms) or an administrator restarts the controller. Interface missing or down: closed, and
// opened again as soon as it is there and up. Frames that came before the loss are handed on.
// Frames are stamped by the kernel (CLOCK_REALTIME, software).
class SocketCanSource final : public live::LiveSource {
 public:
  static constexpr std::size_t kBatch = 32;  // frames of one system call

  // `receiver` and `tap` outlive the source. The tap hears the frames that pass the filters.
  SocketCanSource(const SocketCanOptions& options, can::FrameReceiver& receiver,
                  live::RawTap* tap = nullptr);

  void receive(Duration wait) noexcept override;

  [[nodiscard]] live::LinkState link() const noexcept override { return status_.state(); }
  [[nodiscard]] int last_error() const noexcept override { return status_.last_error(); }
  [[nodiscard]] can::ControllerState controller() const noexcept {
    return controller_.load(std::memory_order_relaxed);  // pairs with the stores
  }
  [[nodiscard]] const SocketCanCounters& counters() const noexcept { return counters_; }

 private:
  // The kernel fills these in place; they point into each other and are set up once.
  struct Batch {
    static_assert(live::kAncillarySize % alignof(cmsghdr) == 0);
    std::array<std::array<std::byte, can::kFdRecordSize>, kBatch> records;
    alignas(cmsghdr) std::array<std::array<std::byte, live::kAncillarySize>, kBatch> ancillary;
    std::array<iovec, kBatch> vectors;
    std::array<mmsghdr, kBatch> messages;
  };

  void wait_to_open(Duration wait) noexcept;
  void open() noexcept;
  void close(int error) noexcept;
  void read_batch() noexcept;
  [[nodiscard]] int take_batch() noexcept;
  void take(mmsghdr& message) noexcept;
  void follow_controller(const can::CanFrame& frame) noexcept;
  // Until the receiver is to be flushed; not soon when there is nothing to flush.
  [[nodiscard]] Duration time_to_flush() const noexcept;
  void flush() noexcept;

  SocketCanOptions options_;
  std::vector<can_filter> filters_;
  can::FrameReceiver& receiver_;
  live::RawTap* tap_;
  SocketCanCounters counters_;
  live::FileDescriptor socket_;
  live::RetryPause opening_;
  live::LinkStatus status_;
  Batch batch_{};
  live::DropCount drops_;   // of this socket
  bool unflushed_ = false;  // frames came since the last flush
  live::Steady::time_point last_frame_;
  // Relaxed: a value on its own that orders nothing; written by follow_controller() and open(), on
  // the receive thread, read by controller().
  std::atomic<can::ControllerState> controller_{can::ControllerState::active};
};

}  // namespace convexcut::socketcan
