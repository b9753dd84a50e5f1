// SPDX-License-Identifier: Apache-2.0
#include "drivers/xsens/mt_configuration.hpp"

#include <algorithm>
#include <cstdio>

#include "drivers/xsens/baud_code.hpp"
#include "drivers/xsens/xbus_writer.hpp"

namespace convexcut::xsens {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// A device answers within milliseconds; USB adapters add up to 16, slow lines what they hold.
constexpr auto kAnswerTime = milliseconds{250};
constexpr int kTries = 4;
constexpr int kTriesInScan = 2;
constexpr auto kSilence = seconds{2};
constexpr auto kShortestPause = milliseconds{500};
constexpr int kMaxDoublings = 4;  // to 8 s
// After a reset the device takes its time, and it is open which of the two rates it then has.
constexpr std::size_t kRoundsAfterReset = 3;

constexpr std::array<std::uint32_t, 12> kLikelyRates{
    115200, 921600, 460800, 230400, 57600, 2000000, 38400, 19200, 9600, 4800, 3500000, 4000000};

constexpr MessageId message_of(std::uint8_t id) noexcept { return static_cast<MessageId>(id); }

constexpr MessageId acknowledgement(MessageId request) noexcept {
  return static_cast<MessageId>(static_cast<std::uint8_t>(request) + 1);
}

}  // namespace

MtConfiguration::MtConfiguration(const MtConfigurationOptions& options, MtLine& line) noexcept
    : options_(options), line_(line), rate_hz_(options.rate_hz), baud_(options.baud) {}

void MtConfiguration::begin(Time now) noexcept {
  now_ = now;
  baud_tried_ = false;
  failures_ = 0;
  find_rates();
  counters_.dialogues.add();
  enter(Step::go_to_config);
}

void MtConfiguration::end() noexcept {
  set_state(MtState::off);
  due_ = Time::max();
}

void MtConfiguration::update(Time now) noexcept {
  now_ = now;
  if (now < due_) return;
  switch (state()) {
    case MtState::off:
      return;
    case MtState::measuring:
      counters_.silences.add();
      break;
    case MtState::no_answer:
      break;
    default:
      counters_.timeouts.add();
      return on_timeout();
  }
  find_rates();
  counters_.dialogues.add();
  enter(Step::go_to_config);
}

// First where it was last heard, then where it is to be, then where the configuration has it.
void MtConfiguration::find_rates() noexcept {
  rate_count_ = 0;
  rate_ = 0;
  heard_at_ = 0;
  add_rate(baud());
  if (options_.baud == 0) return;
  add_rate(options_.set_baud);
  add_rate(options_.baud);
  if (!options_.scan_baud) return;
  for (const std::uint32_t rate : kLikelyRates) add_rate(rate);
}

void MtConfiguration::add_rate(std::uint32_t baud) noexcept {
  if (baud == 0 && options_.baud != 0) return;
  const auto known = rates_.begin() + static_cast<std::ptrdiff_t>(rate_count_);
  if (rate_count_ == rates_.size() || std::find(rates_.begin(), known, baud) != known) return;
  rates_[rate_count_++] = baud;
}

void MtConfiguration::enter(Step step) noexcept {
  step_ = step;
  tries_ = 0;
  request();
}

void MtConfiguration::request() noexcept {
  ++tries_;
  counters_.requests.add();
  due_ = now_ + kAnswerTime;
  std::array<std::byte, kMaxShortFrame> frame;
  const auto send = [&](MtState state, MessageId message, wire::Bytes payload = {}) {
    set_state(state);
    line_.send(wire::Bytes(frame).first(write_frame(message, payload, frame)));
  };
  switch (step_) {
    case Step::go_to_config:
      return send(MtState::entering_config, MessageId::go_to_config);
    case Step::device_id:
      return send(MtState::identifying, MessageId::req_device_id);
    case Step::product_code:
      return send(MtState::identifying, MessageId::req_product_code);
    case Step::firmware:
      return send(MtState::identifying, MessageId::req_firmware_revision);
    case Step::set_baud: {
      const std::array code{static_cast<std::byte>(code_of_baud(options_.set_baud).value_or(0))};
      return send(MtState::changing_baud, MessageId::baudrate, code);
    }
    case Step::reset:
      return send(MtState::changing_baud, MessageId::reset);
    case Step::read_outputs:
      return send(MtState::setting_outputs, MessageId::set_output_configuration);
    case Step::set_outputs:
      // Once is enough for a device that has answered: from then on it is asked what it has.
      if (differs_) return send(MtState::setting_outputs, MessageId::set_output_configuration);
      return send(MtState::setting_outputs, MessageId::set_output_configuration,
                  mt_output_list(rate_hz_));
    case Step::go_to_measurement:
      return send(MtState::starting, MessageId::go_to_measurement);
  }
}

void MtConfiguration::on_timeout() noexcept {
  // A device that has taken its new rate at once does not hear the reset, and needs none.
  if (step_ == Step::reset) return look_for_rate_after_reset();
  const bool many_rates = step_ == Step::go_to_config && rate_count_ > 1;
  if (tries_ < (many_rates ? kTriesInScan : kTries)) return request();
  if (step_ == Step::go_to_config) return try_next_rate();
  if (step_ == Step::set_outputs && differs_) {
    outcome_.store(MtOutcome::differs, std::memory_order_relaxed);
    return advance();
  }
  give_up();
}

void MtConfiguration::try_next_rate() noexcept {
  if (++rate_ == rate_count_) return give_up();
  set_line(rates_[rate_]);
  enter(Step::go_to_config);
}

void MtConfiguration::give_up() noexcept {
  // A device that sends is heard even if it does not listen.
  if (heard_at_ != 0) set_line(heard_at_);
  set_state(MtState::no_answer);
  due_ = now_ + kShortestPause * (1 << std::min(failures_, kMaxDoublings));
  ++failures_;
}

void MtConfiguration::on_frame(const XbusFrame& frame) noexcept {
  const MessageId message = message_of(frame.message_id);
  switch (state()) {
    case MtState::off:
    case MtState::no_answer:
      return;
    case MtState::measuring:
      if (message == MessageId::mtdata2) due_ = now_ + kSilence;
      return;
    default:
      break;
  }
  if (message == MessageId::mtdata2) {
    heard_at_ = baud();
    // As good as the acknowledgement, which may have been lost.
    if (step_ == Step::go_to_measurement) measuring();
  } else if (message == MessageId::error) {
    on_error(frame);
  } else if (message == MessageId::wake_up) {
    if (step_ == Step::go_to_config) request();  // it listens now
  } else {
    on_answer(frame);
  }
}

// Only the answer to the newest request counts: late ones of earlier steps are passed over.
void MtConfiguration::on_answer(const XbusFrame& frame) noexcept {
  const auto answers = [&](MessageId request) {
    return message_of(frame.message_id) == acknowledgement(request);
  };
  switch (step_) {
    case Step::go_to_config:
      if (answers(MessageId::go_to_config)) advance();
      return;
    case Step::device_id:
    case Step::product_code:
    case Step::firmware:
      return note_identity(frame);
    case Step::set_baud:
      if (!answers(MessageId::baudrate)) return;
      asked_at_ = baud();
      return enter(Step::reset);
    case Step::reset:
      if (answers(MessageId::reset)) look_for_rate_after_reset();
      return;
    case Step::read_outputs:
    case Step::set_outputs:
      if (answers(MessageId::set_output_configuration)) on_outputs(frame.payload);
      return;
    case Step::go_to_measurement:
      if (answers(MessageId::go_to_measurement)) measuring();
      return;
  }
}

void MtConfiguration::on_error(const XbusFrame& frame) noexcept {
  counters_.errors.add();
  const std::uint8_t code = frame.payload.empty() ? 0 : wire::load_u8(frame.payload, 0);
  last_error_.store(code, std::memory_order_relaxed);
  switch (step_) {
    case Step::device_id:
    case Step::product_code:
    case Step::firmware:
    case Step::set_baud:
    case Step::read_outputs:
      return advance();
    case Step::set_outputs:
      outcome_.store(MtOutcome::refused, std::memory_order_relaxed);
      return advance();
    case Step::go_to_config:
    case Step::reset:
    case Step::go_to_measurement:
      return;  // it is asked again
  }
}

void MtConfiguration::note_identity(const XbusFrame& frame) noexcept {
  const MessageId message = message_of(frame.message_id);
  const wire::Bytes payload = frame.payload;
  if (step_ == Step::device_id && message == MessageId::device_id) {
    if (payload.size() >= sizeof(std::uint32_t)) {
      device_id_.store(wire::load_be<std::uint32_t>(payload, 0), std::memory_order_relaxed);
    }
  } else if (step_ == Step::product_code && message == MessageId::product_code) {
    for (std::size_t i = 0; i < product_code_.size(); ++i) {
      const char c = i < payload.size() ? static_cast<char>(payload[i]) : ' ';
      product_code_[i].store(c, std::memory_order_relaxed);
    }
  } else if (step_ == Step::firmware && message == MessageId::firmware_revision) {
    if (payload.size() >= 3) {
      const std::uint32_t version = std::uint32_t{wire::load_u8(payload, 0)} << 16U |
                                    std::uint32_t{wire::load_u8(payload, 1)} << 8U |
                                    wire::load_u8(payload, 2);
      firmware_.store(version, std::memory_order_relaxed);
    }
  } else {
    return;
  }
  advance();
}

void MtConfiguration::advance() noexcept {
  switch (step_) {
    case Step::go_to_config:
      failures_ = 0;
      rate_hz_ = mt_rate_for(options_.rate_hz, baud());
      return enter(Step::device_id);
    case Step::device_id:
      return enter(Step::product_code);
    case Step::product_code:
      return enter(Step::firmware);
    case Step::firmware:
      identified_.store(true, std::memory_order_release);  // pairs with identity()
      return after_identity();
    case Step::set_baud:
      return enter(Step::read_outputs);
    case Step::read_outputs:
      differs_ = false;
      return enter(Step::set_outputs);
    case Step::set_outputs:
      return enter(Step::go_to_measurement);
    case Step::reset:
    case Step::go_to_measurement:
      return;  // these end in other ways
  }
}

void MtConfiguration::after_identity() noexcept {
  const bool other = options_.baud != 0 && options_.set_baud != 0 && baud() != options_.set_baud;
  if (other && !baud_tried_) {
    baud_tried_ = true;
    // A device at a rate that the host's end does not have would be lost.
    const bool host_can = line_.set_baud(options_.set_baud);
    line_.set_baud(baud());
    if (host_can) return enter(Step::set_baud);
  }
  if (rate_hz_ < options_.rate_hz) counters_.slower_lines.add();
  enter(Step::read_outputs);
}

void MtConfiguration::look_for_rate_after_reset() noexcept {
  rate_count_ = 0;
  for (std::size_t i = 0; i < kRoundsAfterReset; ++i) {
    rates_[rate_count_++] = options_.set_baud;
    rates_[rate_count_++] = asked_at_;
  }
  rate_ = 0;
  set_line(rates_[0]);
  enter(Step::go_to_config);
}

void MtConfiguration::on_outputs(wire::Bytes list) noexcept {
  if (std::ranges::equal(list, mt_output_list(rate_hz_))) {
    outcome_.store(MtOutcome::as_wanted, std::memory_order_relaxed);
    return enter(Step::go_to_measurement);
  }
  if (step_ == Step::read_outputs) {
    // What is set is written to the device's flash memory: not each time, only where it differs.
    differs_ = false;
    return enter(Step::set_outputs);
  }
  // A late answer to the question looks the same: it is waited for another one.
  differs_ = true;
}

void MtConfiguration::measuring() noexcept {
  counters_.completed.add();
  set_state(MtState::measuring);
  due_ = now_ + kSilence;
}

void MtConfiguration::set_line(std::uint32_t baud) noexcept {
  if (baud == this->baud()) return;
  baud_.store(baud, std::memory_order_relaxed);
  line_.set_baud(baud);
}

std::string MtConfiguration::identity() const {
  if (!identified_.load(std::memory_order_acquire)) return {};  // pairs with advance()
  std::string text;
  for (const std::atomic<char>& c : product_code_) {
    const char letter = c.load(std::memory_order_relaxed);
    if (letter > ' ' && letter < '\x7F') text += letter;
  }
  const std::uint32_t version = firmware_.load(std::memory_order_relaxed);
  std::array<char, 64> rest{};
  std::snprintf(rest.data(), rest.size(), ", firmware %u.%u.%u, %08X", version >> 16U,
                (version >> 8U) & 0xFFU, version & 0xFFU,
                device_id_.load(std::memory_order_relaxed));
  return text + rest.data();
}

}  // namespace convexcut::xsens
