// SPDX-License-Identifier: Apache-2.0
//
// Records of sockets and captures. Does not prove what a kernel or libpcap really delivers: the
// records are made by hand from their documented layout.
#include "drivers/can/socketcan_layout.hpp"

#include <bit>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/recordings.hpp"

namespace convexcut::can {
namespace {

using convexcut::test::hex;
using Record = std::vector<std::byte>;

constexpr HostTime kStamp = from_ns<HostTime>(1'700'000'000'000'100'000);

struct Decoded {
  RecordStatus status;
  CanFrame frame;
};
Decoded decode(const Record& record, IdOrder order = IdOrder::big_endian) {
  Decoded decoded{};
  decoded.status = decode_socketcan(record, order, kStamp, decoded.frame);
  return decoded;
}

Record padded(std::string_view text, std::size_t size) {
  Record record = hex(text);
  record.resize(size);
  return record;
}

TEST(SocketCan, ClassicFrameOfACapture) {
  const auto [status, frame] = decode(hex("00000034 06000000 0000000009CF0000"));
  ASSERT_EQ(status, RecordStatus::ok);
  EXPECT_EQ(frame.id, 0x34U);
  EXPECT_EQ(frame.stamp, kStamp);
  EXPECT_FALSE(frame.extended || frame.remote || frame.error || frame.fd);
  EXPECT_THAT(frame.payload(), testing::ElementsAreArray(hex("0000000009CF")));
}

TEST(SocketCan, IdOfACaptureIsBigEndianAndOfASocketTheHosts) {
  EXPECT_EQ(decode(padded("80000000 00", 16)).status, RecordStatus::ok);
  EXPECT_TRUE(decode(padded("80000000 00", 16)).frame.extended);
  const bool little = std::endian::native == std::endian::little;
  const Record of_socket = padded(little ? "34120080 00" : "80001234 00", 16);
  const auto [status, frame] = decode(of_socket, IdOrder::host);
  ASSERT_EQ(status, RecordStatus::ok);
  EXPECT_TRUE(frame.extended);
  EXPECT_EQ(frame.id, 0x1234U);
}

TEST(SocketCan, FlagsAreTakenOutOfTheId) {
  const CanFrame extended = decode(padded("9FFFFFFF 00", 16)).frame;
  EXPECT_TRUE(extended.extended);
  EXPECT_EQ(extended.id, 0x1FFFFFFFU);
  const CanFrame remote = decode(padded("40000123 04", 16)).frame;
  EXPECT_TRUE(remote.remote);
  EXPECT_EQ(remote.id, 0x123U);
  EXPECT_EQ(remote.length, 0) << "a request has no data, whatever length it asks for";
  const CanFrame error = decode(padded("20000040 08", 16)).frame;
  EXPECT_TRUE(error.error);
  EXPECT_FALSE(error.extended);
  EXPECT_EQ(error.id, 0x40U);
  EXPECT_EQ(error.length, 8);
}

TEST(SocketCan, StandardIdOfMoreThanElevenBitsIsRejected) {
  EXPECT_EQ(decode(padded("00000800 00", 16)).status, RecordStatus::bad_id);
  EXPECT_EQ(decode(padded("80000800 00", 16)).status, RecordStatus::ok);
}

TEST(SocketCan, FdIsToldByFlagBySizeOrByLength) {
  EXPECT_FALSE(decode(padded("00000001 08 00", 16)).frame.fd);
  EXPECT_TRUE(decode(padded("00000001 08 04", 72)).frame.fd);
  EXPECT_TRUE(decode(padded("00000001 08 00", 72)).frame.fd) << "older writers set no flag";
  EXPECT_TRUE(decode(padded("00000001 0C 00", 20)).frame.fd) << "stored without padding";
  EXPECT_TRUE(decode(padded("00000001 08 05", 16)).frame.fd);
}

TEST(SocketCan, FdFrameOfFullLength) {
  Record record = padded("80ABCDEF 40 07", 72);
  record.back() = std::byte{0x5A};
  const auto [status, frame] = decode(record);
  ASSERT_EQ(status, RecordStatus::ok);
  EXPECT_EQ(frame.id, 0xABCDEFU);
  EXPECT_EQ(frame.length, 64);
  EXPECT_EQ(frame.data[63], std::byte{0x5A});
}

TEST(SocketCan, CanXlIsRecognised) {
  EXPECT_EQ(decode(padded("00000123 80", 80)).status, RecordStatus::can_xl);
}

TEST(SocketCan, EveryLengthInEverySizeOfRecordIsDecodedOrRejected) {
  for (std::size_t size = 0; size <= 80; ++size) {
    for (unsigned length = 0; length < 128; ++length) {
      Record record(size, std::byte{0xEE});
      if (size >= 8) {
        for (std::size_t i = 0; i < 8; ++i) record[i] = std::byte{0};
        record[kSocketCanLengthOffset] = static_cast<std::byte>(length);
      }
      const bool fd = size == 72 || (length > 8 && size != 16);
      const bool fits = size >= 8 && is_valid_length(length, fd) && size - 8 >= length;
      const auto [status, frame] = decode(record);
      ASSERT_EQ(status == RecordStatus::ok, fits) << length << " in " << size;
      ASSERT_EQ(frame.length, fits ? length : 0U) << length << " in " << size;
    }
  }
}

TEST(CanFrame, LengthsBetweenThoseOfADlcDoNotExist) {
  std::vector<std::size_t> lengths;
  for (std::size_t length = 0; length <= 70; ++length) {
    if (is_valid_length(length, true)) lengths.push_back(length);
    EXPECT_EQ(is_valid_length(length, false), length <= 8);
  }
  EXPECT_THAT(lengths, testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64));
}

TEST(CanFrame, BusTimeIsThatOfItsBits) {
  CanFrame frame;
  frame.length = 8;
  EXPECT_EQ(bus_time(frame, 250'000), std::chrono::microseconds{432});  // 108 bits
  frame.extended = true;
  EXPECT_EQ(bus_time(frame, 500'000), std::chrono::microseconds{256});  // 128 bits
  EXPECT_EQ(bus_time(frame, 0), Duration{0});
}

}  // namespace
}  // namespace convexcut::can
