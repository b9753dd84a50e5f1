// SPDX-License-Identifier: Apache-2.0
//
// An Xsens MTi on a serial line: bytes in, ImuSamples out.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "core/counter.hpp"
#include "core/imu_sample.hpp"
#include "core/sink.hpp"
#include "core/time.hpp"
#include "drivers/wire.hpp"
#include "drivers/xsens/loss_counter.hpp"
#include "drivers/xsens/mtdata2.hpp"
#include "drivers/xsens/sample_clock.hpp"
#include "drivers/xsens/to_sample.hpp"
#include "drivers/xsens/xbus_framer.hpp"
#include "drivers/xsens/xbus_observer.hpp"

namespace convexcut::xsens {

struct ImuDriverOptions {
  std::uint32_t baud = 115200;  // bit/s, 10 bits a byte; 0: no line rate (USB)
  // For a recording without stamps: the arrival of its first sample. The others follow at the
  // device's own time; samples without device time are dropped and counted.
  std::optional<HostTime> unstamped_start{};
};

struct ImuCounters {
  XbusCounters xbus;
  Counter data_messages;       // MTData2
  Counter other_messages;      // WakeUp, acknowledges, configuration, …
  Counter error_messages;      // the device reports an error: last_error
  Counter truncated_payloads;  // MTData2 dropped: an item reaches past the end
  Counter wrong_item_sizes;    // MTData2 dropped: a known item of another size
  Counter without_inertial;    // MTData2 without orientation, rate of turn and acceleration
  ValueCounters values;
  Counter lost_messages;     // left out by PacketCounter
  Counter counter_restarts;  // PacketCounter repeated or went back
  Counter no_device_time;    // dropped: unstamped recording, and no SampleTimeFine either
  Counter samples;           // handed to the sink
  Counter sink_full;         // dropped: the sink had no room
  std::atomic<std::uint8_t> last_error{0};  // code of the last error message (error_code.hpp)
};

// counters() from any thread, all else on one. RT: no allocation, no lock, no system call.
class ImuDriver {
 public:
  // `sink` outlives the driver.
  ImuDriver(const ImuDriverOptions& options, Sink<ImuSample>& sink) noexcept;
  ImuDriver(const ImuDriver&) = delete;
  ImuDriver& operator=(const ImuDriver&) = delete;

  // The bytes of one read, which returned at `stamp` (ignored for unstamped recordings). A frame
  // that ends inside the chunk arrived before it by the line time of the bytes behind it.
  void on_bytes(wire::Bytes bytes, HostTime stamp) noexcept;

  // The rate of the line has changed.
  void set_baud(std::uint32_t baud) noexcept { options_.baud = baud; }
  // Who hears each frame before it is decoded; null: nobody. Before the first bytes.
  void set_observer(XbusObserver* observer) noexcept { observer_ = observer; }

  [[nodiscard]] const ImuCounters& counters() const noexcept { return counters_; }

 private:
  void on_frame(const XbusFrame& frame, HostTime stamp) noexcept;
  void on_data(const XbusFrame& frame, HostTime stamp) noexcept;
  void emit(const MtMeasurement& m, std::optional<ImuTime> device_time, HostTime arrival) noexcept;
  [[nodiscard]] HostTime unstamped_arrival(ImuTime device_time) noexcept;

  ImuDriverOptions options_;
  Sink<ImuSample>& sink_;
  XbusObserver* observer_ = nullptr;
  ImuCounters counters_;
  XbusFramer framer_{counters_.xbus};
  LossCounter loss_{counters_.lost_messages, counters_.counter_restarts};
  SampleClock clock_ = SampleClock::sample_time_fine();
  std::optional<ImuTime> first_device_time_;  // of the first sample
};

}  // namespace convexcut::xsens
