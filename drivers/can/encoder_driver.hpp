// SPDX-License-Identifier: Apache-2.0
//
// The encoder of a stage on a CAN bus: frames in, EncoderSamples out.
#pragma once

#include <cstdint>

#include "core/counter.hpp"
#include "core/encoder_sample.hpp"
#include "core/sink.hpp"
#include "drivers/can/can_frame.hpp"
#include "drivers/can/frame_receiver.hpp"
#include "drivers/can/signal.hpp"

namespace convexcut::can {

struct EncoderOptions {
  CanId id{};
  Signal signal{};                  // its value is the angle in degrees
  std::uint32_t bitrate = 250'000;  // bit/s; 0: frames take no time
};

struct EncoderCounters {
  Counter frames;         // of its identifier
  Counter remote_frames;  // ignored
  Counter other_signals;  // ignored: they do not begin with the signal's prefix
  Counter short_frames;   // ignored: the signal is not all there
  Counter samples;        // handed to the sink
  Counter sink_full;      // dropped: the sink had no room
};

// A sample's `arrival` is the frame's stamp less the time that it was on the bus.
// on_frame on one thread; counters from any. RT: no allocation, no lock, no system call.
class EncoderDriver final : public FrameReceiver {
 public:
  // `sink` outlives the driver. Throws std::invalid_argument when no frame can hold the signal.
  EncoderDriver(const EncoderOptions& options, Sink<EncoderSample>& sink);

  // Frames of other identifiers are not counted: they are other devices'.
  void on_frame(const CanFrame& frame) noexcept override;
  void flush() noexcept override {}  // a frame is a sample: nothing waits

  [[nodiscard]] const CanId& id() const noexcept { return options_.id; }
  [[nodiscard]] const EncoderCounters& counters() const noexcept { return counters_; }

 private:
  EncoderOptions options_;
  std::size_t needed_length_;
  Sink<EncoderSample>& sink_;
  EncoderCounters counters_;
};

}  // namespace convexcut::can
