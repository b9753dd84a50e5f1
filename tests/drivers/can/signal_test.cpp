// SPDX-License-Identifier: Apache-2.0
//
// Numbers in CAN data. The oracle writes bits in the order that DBC files define; it does not prove
// that a device's documentation is read rightly.
#include "drivers/can/signal.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/recordings.hpp"

namespace convexcut::can {
namespace {

using convexcut::test::hex;

double value(const Signal& signal, std::string_view data) { return value_of(signal, hex(data)); }

TEST(Signal, IntelSignalIsLeastSignificantByteFirst) {
  // Bosch LWS steering angle, identifier 0x2B0: i16 of 0.1° in bytes 0 and 1.
  const Signal angle{.start_bit = 0, .length = 16, .scale = 0.1};
  EXPECT_DOUBLE_EQ(value(angle, "D2 04 00 07 00"), 123.4);
  EXPECT_DOUBLE_EQ(value(angle, "2E FB 00 07 00"), -123.4);
  // Its angular speed: u8 of 4 °/s in byte 2.
  EXPECT_DOUBLE_EQ(
      value({.start_bit = 16, .length = 8, .is_signed = false, .scale = 4.0}, "00 00 FF 07 00"),
      1020.0);
}

TEST(Signal, MotorolaSignalIsMostSignificantByteFirst) {
  // z of an Xsens Acceleration message: i16 of 2^-8 m/s² in bytes 4 and 5. Its most significant bit
  // is bit 7 of byte 4.
  const Signal z{.order = ByteOrder::motorola, .start_bit = 39, .length = 16, .scale = 1.0 / 256.0};
  EXPECT_DOUBLE_EQ(value(z, "00 00 00 00 09 CF"), 2511.0 / 256.0);
  EXPECT_DOUBLE_EQ(value(z, "00 00 00 00 F6 31"), -2511.0 / 256.0);
}

TEST(Signal, Cia402PositionIsBehindTheStatusword) {
  EXPECT_EQ(value(cia402_position(), "37 06 D2 02 96 49"), 1234567890.0);
  EXPECT_EQ(value(cia402_position(), "37 06 FF FF FF FF"), -1.0);
  EXPECT_EQ(needed_length(cia402_position()), 6U);
}

TEST(Signal, Cia402PositionIsTakenFromSdoAnswersOfItsObjectOnly) {
  const Signal signal = cia402_position_sdo();
  EXPECT_TRUE(has_prefix(signal, hex("43 64 60 00 10 27 00 00")));
  EXPECT_EQ(value(signal, "43 64 60 00 F0 D8 FF FF"), -10000.0);
  EXPECT_FALSE(has_prefix(signal, hex("43 6C 60 00 10 27 00 00")));  // velocity
  EXPECT_FALSE(has_prefix(signal, hex("80 64 60 00 02 00 01 06")));  // abort
  EXPECT_FALSE(has_prefix(signal, hex("43 64 60")));
  EXPECT_EQ(needed_length(signal), 8U);
}

TEST(Signal, ScaleAndOffsetAreApplied) {
  const Signal signal{.length = 8, .is_signed = false, .scale = -0.5, .offset = 90.0};
  EXPECT_EQ(value(signal, "00"), 90.0);
  EXPECT_EQ(value(signal, "FF"), -37.5);
}

TEST(Signal, WholeSixtyFourBits) {
  for (const ByteOrder order : {ByteOrder::intel, ByteOrder::motorola}) {
    Signal signal{.order = order, .start_bit = 0, .length = 64};
    if (order == ByteOrder::motorola) signal.start_bit = 7;
    EXPECT_EQ(value(signal, "FF FF FF FF FF FF FF FF"), -1.0);
    signal.is_signed = false;
    EXPECT_EQ(value(signal, "FF FF FF FF FF FF FF FF"), 0x1p64);
  }
}

// The position of the bit of weight 2^i, as DBC files number bits.
unsigned position(const Signal& signal, unsigned weight) {
  if (signal.order == ByteOrder::intel) return signal.start_bit + weight;
  // Counted through the frame from the most significant bit of byte 0 on, Motorola bits follow one
  // another.
  const unsigned in_line = signal.start_bit / 8 * 8 + 7 - signal.start_bit % 8;
  const unsigned at = in_line + signal.length - 1 - weight;
  return at / 8 * 8 + 7 - at % 8;
}

TEST(Signal, EveryPlaceAndLengthGivesBackWhatWasWritten) {
  std::mt19937_64 random(402);
  for (const ByteOrder order : {ByteOrder::intel, ByteOrder::motorola}) {
    for (unsigned start = 0; start < 128; ++start) {
      for (unsigned length = 1; length <= 64; ++length) {
        const Signal signal{.order = order,
                            .start_bit = start,
                            .length = length,
                            .is_signed = (random() & 1U) != 0};
        const std::uint64_t raw = random() >> (64 - length);
        std::array<std::byte, kMaxFdLength> data{};
        for (std::byte& b : data) b = static_cast<std::byte>(random());
        std::size_t last_byte = 0;
        for (unsigned weight = 0; weight < length; ++weight) {
          const unsigned at = position(signal, weight);
          const std::byte bit{static_cast<unsigned char>(1U << (at % 8))};
          data[at / 8] = (raw >> weight & 1U) != 0 ? data[at / 8] | bit : data[at / 8] & ~bit;
          last_byte = std::max<std::size_t>(last_byte, at / 8);
        }
        ASSERT_EQ(needed_length(signal), last_byte + 1) << start << " " << length;
        const bool negative = signal.is_signed && (raw >> (length - 1) & 1U) != 0;
        const double expected = negative
                                    ? -static_cast<double>((~raw + 1) & (~0ULL >> (64 - length)))
                                    : static_cast<double>(raw);
        ASSERT_EQ(value_of(signal, std::span(data).first(last_byte + 1)), expected)
            << start << " " << length;
      }
    }
  }
}

TEST(Signal, WhatNoFrameCanHoldHasNoLength) {
  EXPECT_EQ(needed_length({.start_bit = 0, .length = 0}), std::nullopt);
  EXPECT_EQ(needed_length({.start_bit = 0, .length = 65}), std::nullopt);
  EXPECT_EQ(needed_length({.start_bit = 512, .length = 1}), std::nullopt);
  EXPECT_EQ(needed_length({.start_bit = 511, .length = 1}), 64U);
  EXPECT_EQ(needed_length({.start_bit = 481, .length = 32}), std::nullopt);
  EXPECT_EQ(needed_length({.start_bit = 480, .length = 32}), 64U);
  const auto motorola = [](unsigned start, unsigned length) {
    return needed_length({.order = ByteOrder::motorola, .start_bit = start, .length = length});
  };
  EXPECT_EQ(motorola(511, 8), 64U);
  EXPECT_EQ(motorola(511, 9), std::nullopt);
  EXPECT_EQ(motorola(504, 1), 64U);
  EXPECT_EQ(motorola(504, 2), std::nullopt);
  EXPECT_EQ(needed_length({.length = 8, .prefix_length = 5}), std::nullopt);
  EXPECT_EQ(needed_length({.length = 8, .prefix_length = 4}), 4U);
  EXPECT_EQ(needed_length({.start_bit = std::numeric_limits<unsigned>::max(), .length = 64}),
            std::nullopt);
}

}  // namespace
}  // namespace convexcut::can
