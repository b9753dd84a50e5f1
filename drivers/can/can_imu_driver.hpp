// SPDX-License-Identifier: Apache-2.0
//
// An Xsens MTi on a CAN bus: frames in, ImuSamples out. Same samples as over serial, within the
// resolution of the CAN scales.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/counter.hpp"
#include "core/imu_sample.hpp"
#include "core/sink.hpp"
#include "core/time.hpp"
#include "drivers/can/can_frame.hpp"
#include "drivers/can/frame_receiver.hpp"
#include "drivers/can/xsens_can.hpp"
#include "drivers/xsens/loss_counter.hpp"
#include "drivers/xsens/sample_clock.hpp"
#include "drivers/xsens/to_sample.hpp"

namespace convexcut::can {

struct CanImuOptions {
  XsensCanIds ids{};
  std::uint32_t bitrate = 250'000;  // bit/s; 0: frames take no time
  // Frames further apart than this are of different samples.
  Duration group_timeout = std::chrono::milliseconds{20};
};

// The identifiers of the messages that samples are made of, and of the device's reports: what a
// socket has to let through.
[[nodiscard]] std::vector<CanId> received_ids(const XsensCanIds& ids);

struct CanImuCounters {
  Counter frames;           // all
  Counter error_frames;     // the controller's reports
  Counter bus_off;          // of these, bus off: the controller is silent until it is restarted
  Counter remote_frames;    // ignored
  Counter foreign_frames;   // ignored: other ids, the other id length, CAN FD
  Counter short_frames;     // ignored: fewer bytes than the message has
  Counter stray_frames;     // ignored: high-rate data outside of any group
  Counter late_frames;      // came after the sample of their group had been handed on
  Counter device_errors;    // the device's Error message: last_error
  Counter device_warnings;  // the device's Warning message
  Counter groups;
  Counter groups_without_inertial;
  Counter groups_without_time;  // SampleTime missing: samples without device time
  xsens::ValueCounters values;
  Counter lost_groups;       // left out by GroupCounter
  Counter counter_restarts;  // GroupCounter repeated or went back
  Counter samples;           // handed to the sink
  Counter sink_full;         // dropped: the sink had no room
  std::atomic<std::uint8_t> last_error{0};
};

// The frames of one sample, so far.
struct FrameGroup {
  XsensCanData data;
  HostTime first_stamp{};
  HostTime arrival{};
  std::optional<ImuTime> device_time;
  bool emitted = false;  // its sample has been handed on
};

// A sample is a group of frames: it begins with SampleTime or GroupCounter, or with a message that
// the group at hand has already, or after a pause. It is handed on as soon as it has what the two
// groups before it had, at the latest when the next one begins. `arrival` is the stamp of the
// group's first frame less the time that this frame was on the bus: the sample existed before its
// transmission began, and the frames after the first can be held up by other traffic.
// on_frame and flush on one thread; counters from any. RT: no allocation, no lock, no system call.
class CanImuDriver final : public FrameReceiver {
 public:
  // `sink` outlives the driver.
  CanImuDriver(const CanImuOptions& options, Sink<ImuSample>& sink) noexcept;

  void on_frame(const CanFrame& frame) noexcept override;
  // Ends the group at hand: at the end of a log, or when nothing has come for the group timeout.
  void flush() noexcept override;

  [[nodiscard]] const CanImuCounters& counters() const noexcept { return counters_; }

 private:
  void count_error_frame(const CanFrame& frame) noexcept;
  void on_report(XsensMessage message, const XsensCanData& data) noexcept;
  void on_message(XsensMessage message, const CanFrame& frame) noexcept;
  [[nodiscard]] bool begins_group(XsensMessage message, HostTime stamp) const noexcept;
  [[nodiscard]] bool is_complete() const noexcept;
  void emit() noexcept;

  CanImuOptions options_;
  Sink<ImuSample>& sink_;
  CanImuCounters counters_;
  xsens::LossCounter loss_{counters_.lost_groups, counters_.counter_restarts};
  xsens::SampleClock clock_ = xsens::SampleClock::can_sample_time();
  std::optional<FrameGroup> group_;
  // The messages that make a sample, of the last two groups.
  std::uint32_t last_messages_ = 0;
  std::uint32_t last_but_one_messages_ = 0;
};

}  // namespace convexcut::can
