// SPDX-License-Identifier: Apache-2.0
//
// Any signal in the data of any frame: the first bytes describe the signal, the rest is the frame.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/encoder_sample.hpp"
#include "drivers/can/encoder_driver.hpp"
#include "drivers/can/signal.hpp"
#include "tests/fuzz/xsens/check.hpp"

namespace {

using convexcut::fuzz::require;
namespace can = convexcut::can;

class AngleSink final : public convexcut::Sink<convexcut::EncoderSample> {
 public:
  [[nodiscard]] convexcut::EncoderSample* claim() noexcept override { return &sample_; }
  void commit() noexcept override {
    require(std::isfinite(sample_.angle.value), "angles are numbers");
    ++count_;
  }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }

 private:
  convexcut::EncoderSample sample_;
  std::size_t count_ = 0;
};

class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  std::uint8_t byte() {
    if (size_ == 0) return 0;
    --size_;
    return *data_++;
  }
  std::uint16_t word() { return static_cast<std::uint16_t>(byte() | byte() << 8U); }
  [[nodiscard]] std::size_t left() const { return size_; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

can::Signal signal_of(Input& input) {
  can::Signal signal;
  const std::uint8_t bits = input.byte();
  signal.order = (bits & 1U) != 0 ? can::ByteOrder::motorola : can::ByteOrder::intel;
  signal.is_signed = (bits & 2U) != 0;
  signal.prefix_length = bits >> 2U & 7U;
  signal.start_bit = input.word();
  signal.length = input.byte();
  signal.scale = static_cast<std::int16_t>(input.word()) / 256.0;
  signal.offset = static_cast<std::int16_t>(input.word()) / 256.0;
  for (std::byte& b : signal.prefix) b = std::byte{input.byte()};
  return signal;
}

can::CanFrame frame_of(Input& input) {
  can::CanFrame frame;
  const std::uint8_t bits = input.byte();
  frame.fd = (bits & 1U) != 0;
  frame.remote = (bits & 2U) != 0;
  frame.error = (bits & 4U) != 0;
  frame.extended = (bits & 8U) != 0;
  const std::size_t longest = frame.fd ? can::kMaxFdLength : can::kMaxClassicLength;
  frame.length = static_cast<std::uint8_t>(std::min(longest, input.left()));
  for (std::size_t i = 0; i < frame.length; ++i) frame.data[i] = std::byte{input.byte()};
  return frame;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  can::EncoderOptions options;
  options.signal = signal_of(input);
  const auto needed = can::needed_length(options.signal);
  if (!needed) return 0;  // the driver refuses it when it is made
  require(*needed >= 1 && *needed <= can::kMaxFdLength, "signals lie within a frame");

  AngleSink sink;
  can::EncoderDriver driver(options, sink);
  const can::CanFrame frame = frame_of(input);
  driver.on_frame(frame);
  const bool whole = !frame.error && !frame.remote && !frame.extended && frame.length >= *needed &&
                     can::has_prefix(options.signal, frame.payload());
  require(sink.count() == (whole ? 1U : 0U), "a sample of each whole frame and of no other");
  if (!whole) return 0;

  // A value is within what its bits can hold.
  can::Signal raw = options.signal;
  raw.scale = 1.0;
  raw.offset = 0.0;
  const double value = can::value_of(raw, frame.payload());
  const double span = std::exp2(raw.length);
  require(raw.is_signed ? value >= -span / 2 && value <= span / 2 : value >= 0 && value <= span,
          "values of so many bits");
  // Bytes past the signal do not matter, and the sign is that of the most significant bit.
  const auto exact = frame.payload().first(*needed);
  require(can::value_of(raw, exact) == value, "what lies behind a signal is not part of it");
  raw.is_signed = !raw.is_signed;
  const double other = can::value_of(raw, frame.payload());
  require(other == value || std::abs(std::abs(other - value) - span) <= span * 1e-15,
          "the sign takes off one span of values");
  return 0;
}
