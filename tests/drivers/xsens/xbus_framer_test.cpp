// SPDX-License-Identifier: Apache-2.0
//
// Framing of byte streams. Does not prove what the messages mean, nor that a real device's line
// errors look like these.
#include "drivers/xsens/xbus_framer.hpp"

#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/drivers/xsens/frames.hpp"

namespace convexcut::xsens {
namespace {

using test::append;
using test::ByteVector;
using test::hex;
using test::make_frame;

struct Seen {
  std::uint8_t message_id;
  ByteVector payload;
  std::size_t size;
  friend bool operator==(const Seen&, const Seen&) = default;
};

// Feeds and records.
struct Listener {
  void feed(wire::Bytes bytes) {
    framer.feed(bytes, [this](const XbusFrame& frame) {
      seen.push_back({frame.message_id, {frame.payload.begin(), frame.payload.end()}, frame.size});
      bytes_behind.push_back(frame.bytes_behind);
    });
  }
  [[nodiscard]] std::size_t accounted() const {
    std::size_t total = framer.pending() + counters.skipped_bytes.value();
    for (const Seen& frame : seen) total += frame.size;
    return total;
  }
  XbusCounters counters;
  XbusFramer framer{counters};
  std::vector<Seen> seen;
  std::vector<std::size_t> bytes_behind;
};

ByteVector all_frames() {
  ByteVector stream;
  for (const std::string_view frame : test::kAllFrames) append(stream, hex(frame));
  return stream;
}

ByteVector payload_of_size(std::size_t size) {
  ByteVector payload(size);
  for (std::size_t i = 0; i < size; ++i) payload[i] = static_cast<std::byte>(i * 7 + 1);
  return payload;
}

TEST(XbusFramer, EveryDocumentedFrameIsFoundAlone) {
  for (const std::string_view text : test::kAllFrames) {
    const ByteVector frame = hex(text);
    Listener listener;
    listener.feed(frame);
    ASSERT_EQ(listener.seen.size(), 1U) << text;
    EXPECT_EQ(listener.seen[0].message_id, static_cast<std::uint8_t>(frame[2])) << text;
    EXPECT_EQ(listener.seen[0].payload, test::payload_of(frame)) << text;
    EXPECT_EQ(listener.counters.skipped_bytes.value(), 0U) << text;
  }
}

TEST(XbusFramer, NoTruncationOfAnyFrameIsAFrame) {
  for (const std::string_view text : test::kAllFrames) {
    const ByteVector frame = hex(text);
    for (std::size_t size = 0; size < frame.size(); ++size) {
      Listener listener;
      listener.feed(wire::Bytes(frame).first(size));
      EXPECT_TRUE(listener.seen.empty()) << text << " cut to " << size;
      EXPECT_EQ(listener.framer.pending(), size);
    }
  }
}

TEST(XbusFramer, EveryFlippedBitCostsExactlyThatFrame) {
  const ByteVector good = hex(test::kErrorInvalidParameter);
  const ByteVector next = hex(test::kWakeUp);
  for (std::size_t bit = 8; bit < good.size() * 8; ++bit) {
    ByteVector stream = good;
    stream[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    // Enough good frames behind it to complete whatever length the flip announces.
    for (int i = 0; i < 60; ++i) append(stream, next);
    Listener listener;
    listener.feed(stream);
    EXPECT_EQ(listener.seen.size(), 60U) << "bit " << bit;
    EXPECT_EQ(listener.counters.skipped_bytes.value(), good.size()) << "bit " << bit;
  }
}

TEST(XbusFramer, OneByteChunksGiveTheSameAsOneChunk) {
  const ByteVector stream = all_frames();
  Listener whole;
  Listener bytewise;
  whole.feed(stream);
  for (const std::byte b : stream) bytewise.feed(wire::Bytes(&b, 1));
  EXPECT_EQ(whole.seen.size(), test::kAllFrames.size());
  EXPECT_EQ(bytewise.seen, whole.seen);
}

TEST(XbusFramer, GarbageBeforeBetweenAndAfterIsSkippedAndCounted) {
  const ByteVector garbage = hex("00 FA 36 FA FA 11 22 FF 36");
  ByteVector stream = garbage;
  append(stream, hex(test::kWakeUp));
  append(stream, garbage);
  append(stream, hex(test::kQuaternionMessage));
  append(stream, garbage);
  Listener listener;
  listener.feed(stream);
  ASSERT_EQ(listener.seen.size(), 2U);
  EXPECT_EQ(listener.counters.skipped_bytes.value(), 3 * garbage.size());
}

TEST(XbusFramer, PreambleInsideDataDoesNotStartAFrame) {
  const ByteVector frame = make_frame(0x36, hex("FA FF 3E 00 C3 FA FA FF FA"));
  Listener listener;
  listener.feed(frame);
  ASSERT_EQ(listener.seen.size(), 1U);
  EXPECT_EQ(listener.seen[0].payload.size(), 9U);
}

TEST(XbusFramer, FrameInsideABadFrameIsFound) {
  // Dropping the whole bad frame would lose the good one that its data holds.
  ByteVector bad = make_frame(0x36, hex("01 02 FA FF 3E 00 C3 03"));
  bad.back() ^= std::byte{1};
  Listener listener;
  listener.feed(bad);
  ASSERT_EQ(listener.seen.size(), 1U);
  EXPECT_EQ(listener.seen[0].message_id, 0x3E);
  EXPECT_EQ(listener.counters.checksum_errors.value(), 1U);
}

TEST(XbusFramer, DoubledPreambleCostsOneByte) {
  ByteVector stream = {std::byte{kPreamble}};
  append(stream, hex(test::kWakeUp));
  Listener listener;
  listener.feed(stream);
  EXPECT_EQ(listener.seen.size(), 1U);
  EXPECT_EQ(listener.counters.skipped_bytes.value(), 1U);
}

TEST(XbusFramer, AnotherBusIdIsNoFrame) {
  ByteVector frame = hex(test::kWakeUp);
  frame[kBusIdOffset] = std::byte{0x01};
  test::seal(frame);
  Listener listener;
  listener.feed(frame);
  EXPECT_TRUE(listener.seen.empty());
  EXPECT_EQ(listener.counters.skipped_bytes.value(), frame.size());
}

TEST(XbusFramer, ExtendedLengthIsAcceptedUpToItsLimit) {
  for (const std::size_t size : {255U, 256U, 1000U, 2047U, 2048U}) {
    Listener listener;
    listener.feed(make_frame(0x36, payload_of_size(size)));
    ASSERT_EQ(listener.seen.size(), 1U) << size;
    EXPECT_EQ(listener.seen[0].payload, payload_of_size(size));
    EXPECT_EQ(listener.seen[0].size, size + 7);
  }
}

TEST(XbusFramer, LongestPlainLengthNeedsNoExtension) {
  Listener listener;
  listener.feed(make_frame(0x36, payload_of_size(254)));
  ASSERT_EQ(listener.seen.size(), 1U);
  EXPECT_EQ(listener.seen[0].size, 254U + 5U);
}

TEST(XbusFramer, ExtendedLengthOutsideItsRangeIsALengthErrorAtOnce) {
  for (const std::size_t size : {2049U, 65535U}) {
    Listener listener;
    ByteVector stream = make_frame(0x36, payload_of_size(size));
    stream.resize(6);  // the header alone: nobody waits for the data
    append(stream, hex(test::kWakeUp));
    listener.feed(stream);
    ASSERT_EQ(listener.seen.size(), 1U) << size;
    EXPECT_EQ(listener.counters.length_errors.value(), 1U);
  }
  ByteVector small = hex("FA FF 36 FF 00 FE");  // 254 fits into the plain length
  append(small, payload_of_size(254));
  small.push_back(std::byte{0});
  test::seal(small);
  Listener listener;
  listener.feed(small);
  EXPECT_TRUE(listener.seen.empty());
  EXPECT_EQ(listener.counters.length_errors.value(), 1U);
}

TEST(XbusFramer, BytesBehindAFrameAreThoseAfterItInTheChunk) {
  const ByteVector frame = hex(test::kWakeUp);  // 5 bytes
  ByteVector stream = frame;
  append(stream, frame);
  append(stream, hex("FA FF 36"));
  Listener listener;
  listener.feed(stream);
  EXPECT_THAT(listener.bytes_behind, testing::ElementsAre(8U, 3U));
}

TEST(XbusFramer, BytesBehindCountAChunkThatIsLargerThanTheBuffer) {
  ByteVector stream = hex(test::kWakeUp);
  append(stream, ByteVector(10'000));
  Listener listener;
  listener.feed(stream);
  EXPECT_THAT(listener.bytes_behind, testing::ElementsAre(10'000U));
}

TEST(XbusFramer, BytesBehindAreZeroForTheFrameThatEndsTheChunk) {
  const ByteVector frame = hex(test::kQuaternionMessage);
  Listener listener;
  listener.feed(wire::Bytes(frame).first(7));
  listener.feed(wire::Bytes(frame).subspan(7));
  EXPECT_THAT(listener.bytes_behind, testing::ElementsAre(0U));
}

TEST(XbusFramer, RandomStreamsAreAccountedForToTheByteInAnyChunking) {
  std::mt19937 random(20261122);
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  for (int round = 0; round < 300; ++round) {
    ByteVector stream;
    while (stream.size() < 6000) {
      ByteVector part = make_frame(0x36, payload_of_size(below(600)));
      if (below(3) == 0) part[below(part.size())] ^= static_cast<std::byte>(1 + below(255));
      if (below(4) == 0) part.resize(below(part.size()));
      append(stream, part);
    }
    Listener whole;
    whole.feed(stream);
    Listener chunked;
    for (wire::Bytes rest = stream; !rest.empty();) {
      const std::size_t size = std::min(rest.size(), 1 + below(3000));
      chunked.feed(rest.first(size));
      rest = rest.subspan(size);
    }
    ASSERT_EQ(chunked.seen, whole.seen);
    ASSERT_EQ(whole.accounted(), stream.size());
    ASSERT_EQ(chunked.accounted(), stream.size());
    ASSERT_GT(whole.seen.size(), 0U);
  }
}

TEST(LineTime, TenBitsAByte) {
  EXPECT_EQ(line_time(54, 115200), Duration{4'687'500});
  EXPECT_EQ(line_time(54, 0), Duration{0});
}

}  // namespace
}  // namespace convexcut::xsens
