// SPDX-License-Identifier: Apache-2.0
//
// The dialogue that makes an MTi send what is wanted (MT Low Level Communication Protocol; facts
// and sources: docs/design/live.md).
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/counter.hpp"
#include "core/time.hpp"
#include "drivers/wire.hpp"
#include "drivers/xsens/mt_outputs.hpp"
#include "drivers/xsens/xbus_observer.hpp"

namespace convexcut::xsens {

struct MtConfigurationOptions {
  std::uint32_t baud = 115200;         // that the line is at, bit/s; 0: it has no rate (USB)
  std::uint32_t set_baud = 0;          // that it shall be at; 0: as it is
  bool scan_baud = false;              // whether other rates are tried when there is no answer
  std::uint16_t rate_hz = kMaxMtRate;  // a divisor of kMaxMtRate
};

// The host's end of the line.
class MtLine {
 public:
  MtLine() = default;
  MtLine(const MtLine&) = delete;
  MtLine& operator=(const MtLine&) = delete;
  virtual ~MtLine() = default;

  virtual void send(wire::Bytes frame) noexcept = 0;
  // False when it does not have the rate; it is then at any.
  virtual bool set_baud(std::uint32_t baud) noexcept = 0;
};

enum class MtState : std::uint8_t {
  off,              // the line is closed
  entering_config,  // the device shall stop to measure
  identifying,
  changing_baud,
  setting_outputs,
  starting,   // the device shall measure
  measuring,  // it does
  no_answer,  // a pause, then all over again
};

enum class MtOutcome : std::uint8_t {
  unknown,
  as_wanted,
  differs,  // the device acknowledged other data or rates
  refused,  // with an error
};

struct MtConfigurationCounters {
  Counter dialogues;  // begun
  Counter completed;  // that ended with a device that measures
  Counter requests;   // sent, with repetitions
  Counter timeouts;   // requests that were not answered in time
  Counter errors;     // that the device answered with
  Counter silences;   // times that a measuring device fell silent, so that it was configured anew
  Counter slower_lines;  // times that the rate had to be lowered: the line's could not be set
};

// Tells the device to stop, asks who it is, sets the line's rate and what is sent, unless they are
// as wanted, and tells it to start again. Nothing is final: what is not answered is asked again, a
// device that does not answer at all is left in peace for ever longer pauses, up to 8 s, and one
// that has fallen silent is configured anew. A device that refuses is set to measure all the same.
//
//   entering_config ─► identifying ─► changing_baud ─► setting_outputs ─► starting ─► measuring
//         ▲ ▲               no answer │      └─► (at either rate) entering_config         │
//         │ └── no_answer ◄───────────┘                                                   │
//         └───────────────────────────────── silence ◄────────────────────────────────────┘
//
// Knows neither clock nor device: it is driven by the times and the frames it is given. Thread:
// state(), outcome(), counters(), the device's identity and baud() from any, all else on one. RT.
class MtConfiguration final : public XbusObserver {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // `line` outlives it.
  MtConfiguration(const MtConfigurationOptions& options, MtLine& line) noexcept;

  // The line has been opened at baud(), or closed.
  void begin(Time now) noexcept;
  void end() noexcept;
  // To be called when time has passed; next_due() says when at the latest.
  void update(Time now) noexcept;
  [[nodiscard]] Time next_due() const noexcept { return due_; }
  // Of the device, at the time of the last update().
  void on_frame(const XbusFrame& frame) noexcept override;

  // These are values on their own and order nothing: relaxed, here and where they are stored.
  [[nodiscard]] MtState state() const noexcept { return state_.load(std::memory_order_relaxed); }
  [[nodiscard]] MtOutcome outcome() const noexcept {
    return outcome_.load(std::memory_order_relaxed);
  }
  // The newest error that the device answered with (error_code.hpp); 0: none.
  [[nodiscard]] std::uint8_t last_error() const noexcept {
    return last_error_.load(std::memory_order_relaxed);
  }
  // That the line is at.
  [[nodiscard]] std::uint32_t baud() const noexcept {
    return baud_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] const MtConfigurationCounters& counters() const noexcept { return counters_; }
  // "MTi-30-2A5G4, firmware 1.8.2, 03800030"; empty until the device has said so. For people.
  [[nodiscard]] std::string identity() const;

 private:
  enum class Step : std::uint8_t {
    go_to_config,
    device_id,
    product_code,
    firmware,
    set_baud,
    reset,
    read_outputs,
    set_outputs,
    go_to_measurement,
  };
  static constexpr std::size_t kProductCodeSize = 20;
  static constexpr std::size_t kMaxRates = 16;

  void find_rates() noexcept;
  void add_rate(std::uint32_t baud) noexcept;
  void enter(Step step) noexcept;
  void request() noexcept;
  void on_timeout() noexcept;
  void try_next_rate() noexcept;
  void give_up() noexcept;
  void on_answer(const XbusFrame& frame) noexcept;
  void on_error(const XbusFrame& frame) noexcept;
  void on_outputs(wire::Bytes list) noexcept;
  void note_identity(const XbusFrame& frame) noexcept;
  void advance() noexcept;
  void after_identity() noexcept;
  void look_for_rate_after_reset() noexcept;
  void measuring() noexcept;
  void set_line(std::uint32_t baud) noexcept;
  void set_state(MtState state) noexcept { state_.store(state, std::memory_order_relaxed); }

  MtConfigurationOptions options_;
  MtLine& line_;
  Time now_{};
  Time due_ = Time::max();  // of the next repetition, try or look for silence
  Step step_ = Step::go_to_config;
  int tries_ = 0;
  int failures_ = 0;                              // dialogues without an answer in a row
  bool baud_tried_ = false;                       // since the line was opened
  bool differs_ = false;                          // what the device has acknowledged
  std::array<std::uint32_t, kMaxRates> rates_{};  // to be tried, the likeliest first
  std::size_t rate_count_ = 0;
  std::size_t rate_ = 0;
  std::uint32_t heard_at_ = 0;  // where a device sends that does not answer
  std::uint32_t asked_at_ = 0;  // where it answered when it was told to change its rate
  std::uint16_t rate_hz_ = kMaxMtRate;

  std::atomic<MtState> state_{MtState::off};
  std::atomic<MtOutcome> outcome_{MtOutcome::unknown};
  std::atomic<std::uint8_t> last_error_{0};
  std::atomic<std::uint32_t> baud_;
  // The identity is published by the release store of identified_, which pairs with identity(). A
  // device that is exchanged for another while it is read may show a mixture once.
  std::atomic<bool> identified_{false};
  std::atomic<std::uint32_t> device_id_{0};
  std::atomic<std::uint32_t> firmware_{0};  // major, minor, revision: a byte each
  std::array<std::atomic<char>, kProductCodeSize> product_code_{};
  MtConfigurationCounters counters_;
};

}  // namespace convexcut::xsens
