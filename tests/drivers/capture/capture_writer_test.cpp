// SPDX-License-Identifier: Apache-2.0
//
// What is written is read back, and is what other tools read. Does not prove that the data survives
// a loss of power between write() and close().
#include "drivers/capture/capture_writer.hpp"

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/capture/capture_reader.hpp"
#include "tests/drivers/capture/capture_bytes.hpp"
#include "tests/support/output_of.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::capture {
namespace {

using test::Octets;
using test::text;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

constexpr std::int64_t kStampNs = 1'700'000'000'123'456'789;

Record datagram(const Octets& payload) {
  return {.stamp = from_ns<HostTime>(kStampNs),
          .kind = RecordKind::datagram,
          .source_port = 2368,
          .destination_port = 8308,
          .source = Ipv4Address::from_octets(192, 168, 1, 201),
          .destination = Ipv4Address::from_octets(255, 255, 255, 255),
          .payload = payload};
}

Record plain(RecordKind kind, const Octets& payload) {
  return {.stamp = from_ns<HostTime>(kStampNs), .kind = kind, .payload = payload};
}

class Writer : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "demo.pcap"; }
  [[nodiscard]] std::filesystem::path part() const { return folder_.path() / "demo.pcap.part"; }

  static std::string error_of(const std::function<void()>& action) {
    try {
      action();
    } catch (const CaptureError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return {};
  }

  test::TemporaryDirectory folder_;
};

TEST_F(Writer, DatagramIsReadBackAsItWas) {
  const Octets payload = text("a payload");
  CaptureWriter writer(file(), LinkKind::ethernet);
  writer.write(datagram(payload));
  writer.close();
  CaptureReader reader(file());
  Record record;
  ASSERT_EQ(reader.next(record), ReadStatus::record);
  EXPECT_EQ(record.kind, RecordKind::datagram);
  EXPECT_EQ(to_ns(record.stamp), kStampNs);
  EXPECT_EQ(record.source, Ipv4Address::from_octets(192, 168, 1, 201));
  EXPECT_EQ(record.destination, Ipv4Address::from_octets(255, 255, 255, 255));
  EXPECT_EQ(record.source_port, 2368);
  EXPECT_EQ(record.destination_port, 8308);
  EXPECT_THAT(record.payload, ElementsAreArray(payload));
  EXPECT_EQ(reader.next(record), ReadStatus::end);
}

TEST_F(Writer, SerialAndCanRecordsAreReadBackAsTheyWere) {
  const Octets payload = test::hex("00 00 00 34 06 00 00 00 00 00 00 00 09 CF");
  for (const auto& [link, kind] : {std::pair{LinkKind::serial, RecordKind::serial},
                                   std::pair{LinkKind::can, RecordKind::can}}) {
    CaptureWriter writer(file(), link);
    writer.write(plain(kind, payload));
    writer.close();
    CaptureReader reader(file());
    EXPECT_EQ(reader.link(), link);
    Record record;
    ASSERT_EQ(reader.next(record), ReadStatus::record);
    EXPECT_EQ(record.kind, kind);
    EXPECT_EQ(to_ns(record.stamp), kStampNs);
    EXPECT_THAT(record.payload, ElementsAreArray(payload));
  }
}

TEST_F(Writer, HeadersAreThoseOfABroadcastDatagram) {
  CaptureWriter writer(file(), LinkKind::ethernet);
  writer.write(datagram(text("hi")));
  writer.close();
  const Octets bytes = test::read_bytes(file());
  constexpr std::size_t kFileAndRecordHeader = 24 + 16;
  ASSERT_GE(bytes.size(), kFileAndRecordHeader);
  const Octets frame(bytes.begin() + kFileAndRecordHeader, bytes.end());
  // The IP checksum was summed by hand: 4500 + 001E + 4011 + C0A8 + 01C9 + FFFF + FFFF → 47A1.
  EXPECT_THAT(frame, ElementsAreArray(test::hex("FFFFFFFFFFFF 020000000001 0800"
                                                "4500001E 00000000 4011B85E C0A801C9 FFFFFFFF"
                                                "0940 2074 000A 0000 6869")));
}

TEST_F(Writer, LargestDatagramFitsAndALargerOneIsRefused) {
  CaptureWriter writer(file(), LinkKind::ethernet);
  writer.write(datagram(Octets(65507)));
  EXPECT_THROW(writer.write(datagram(Octets(65508))), std::invalid_argument);
  writer.close();
  CaptureReader reader(file());
  Record record;
  ASSERT_EQ(reader.next(record), ReadStatus::record);
  EXPECT_EQ(record.payload.size(), 65507U);
}

TEST_F(Writer, LatestStampIsReadBackAndALaterOneIsRefused) {
  constexpr std::int64_t kLast = 0xFFFFFFFFLL * 1'000'000'000 + 999'999'999;
  Record record = plain(RecordKind::serial, {});
  CaptureWriter writer(file(), LinkKind::serial);
  record.stamp = from_ns<HostTime>(kLast);
  writer.write(record);
  record.stamp = from_ns<HostTime>(kLast + 1);
  EXPECT_THROW(writer.write(record), std::invalid_argument);
  record.stamp = from_ns<HostTime>(-1);
  EXPECT_THROW(writer.write(record), std::invalid_argument);
  writer.close();
  CaptureReader reader(file());
  ASSERT_EQ(reader.next(record), ReadStatus::record);
  EXPECT_EQ(to_ns(record.stamp), kLast);
}

TEST_F(Writer, RecordsThatDoNotFitTheCaptureAreRefused) {
  CaptureWriter writer(file(), LinkKind::ethernet);
  EXPECT_THROW(writer.write(plain(RecordKind::serial, {})), std::invalid_argument);
  EXPECT_THROW(writer.write(plain(RecordKind::other, {})), std::invalid_argument);
  EXPECT_THROW(writer.write(plain(RecordKind::datagram, {})), std::invalid_argument);
  EXPECT_THROW(CaptureWriter(file(), LinkKind::linux_cooked), std::invalid_argument);
}

TEST_F(Writer, FinalNameAppearsOnlyWithClose) {
  CaptureWriter writer(file(), LinkKind::serial);
  EXPECT_TRUE(std::filesystem::exists(part()));
  EXPECT_FALSE(std::filesystem::exists(file()));
  writer.close();
  EXPECT_FALSE(std::filesystem::exists(part()));
  EXPECT_TRUE(std::filesystem::exists(file()));
}

TEST_F(Writer, WithoutCloseNothingRemainsAndAnOlderFileStays) {
  test::write_file(file(), text("older"));
  { const CaptureWriter writer(file(), LinkKind::serial); }
  EXPECT_FALSE(std::filesystem::exists(part()));
  EXPECT_EQ(test::read_bytes(file()), text("older"));
}

class WriterAtOnce : public Writer {
 protected:
  static constexpr std::size_t kFileHeader = 24;
  static constexpr std::size_t kRecordHeader = 16;
};

TEST_F(WriterAtOnce, HasItsNameFromTheStartAndKeepsItWithoutClose) {
  {
    CaptureWriter writer(file(), LinkKind::serial, Appears::at_once);
    EXPECT_TRUE(std::filesystem::exists(file()));
    EXPECT_FALSE(std::filesystem::exists(part()));
    writer.write(plain(RecordKind::serial, text("kept")));
  }
  CaptureReader reader(file());
  Record record;
  ASSERT_EQ(reader.next(record), ReadStatus::record);
  EXPECT_THAT(record.payload, ElementsAreArray(text("kept")));
  EXPECT_EQ(reader.next(record), ReadStatus::end);
}

TEST_F(WriterAtOnce, WhatWasFlushedIsInTheFile) {
  CaptureWriter writer(file(), LinkKind::serial, Appears::at_once);
  writer.write(plain(RecordKind::serial, text("four")));
  writer.flush();
  EXPECT_EQ(std::filesystem::file_size(file()), kFileHeader + kRecordHeader + 4);
  CaptureReader reader(file());
  Record record;
  ASSERT_EQ(reader.next(record), ReadStatus::record);
  writer.write(plain(RecordKind::serial, text("and five")));
  writer.close();
  EXPECT_EQ(writer.bytes(), std::filesystem::file_size(file()));
}

TEST_F(WriterAtOnce, NeverOverwrites) {
  test::write_file(file(), text("older"));
  EXPECT_THAT(
      error_of([&] { const CaptureWriter writer(file(), LinkKind::can, Appears::at_once); }),
      HasSubstr("demo.pcap: cannot create: File exists"));
  EXPECT_EQ(test::read_bytes(file()), text("older"));
}

TEST_F(Writer, CountsTheBytesOfDatagramsWithTheirHeaders) {
  CaptureWriter writer(file(), LinkKind::ethernet);
  for (int i = 0; i < 3; ++i) writer.write(datagram(text("hi")));
  writer.close();
  EXPECT_EQ(writer.bytes(), std::filesystem::file_size(file()));
}

TEST_F(Writer, MissingFolderIsAnError) {
  const std::filesystem::path nowhere = folder_.path() / "none" / "demo.pcap";
  EXPECT_THAT(error_of([&] { const CaptureWriter writer(nowhere, LinkKind::serial); }),
              HasSubstr("none/demo.pcap.part: cannot create: No such file or directory"));
}

TEST_F(Writer, NameTakenByAFolderIsAnError) {
  std::filesystem::create_directories(file() / "inside");
  CaptureWriter writer(file(), LinkKind::serial);
  EXPECT_THAT(error_of([&] { writer.close(); }), HasSubstr("cannot rename"));
}

// /dev/full takes nothing: every write is answered with "no space left on device".
class FullDisk : public Writer {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
    std::filesystem::create_symlink("/dev/full", part());
  }
};

TEST_F(FullDisk, IsReportedByWriteAtTheLatestWhenTheBufferIsFull) {
  CaptureWriter writer(file(), LinkKind::serial);
  const Octets payload(1000);
  const auto write_much = [&] {
    for (int i = 0; i < 1000; ++i) writer.write(plain(RecordKind::serial, payload));
  };
  EXPECT_THAT(error_of(write_much), HasSubstr("cannot write: No space left on device"));
  EXPECT_FALSE(std::filesystem::exists(part()));
}

TEST_F(FullDisk, IsReportedByCloseWhenEverythingWasBuffered) {
  CaptureWriter writer(file(), LinkKind::serial);
  writer.write(plain(RecordKind::serial, text("x")));
  EXPECT_THAT(error_of([&] { writer.close(); }), HasSubstr("No space left on device"));
  EXPECT_FALSE(std::filesystem::exists(file()));
}

TEST_F(Writer, TsharkReadsTheSameAndFindsTheIpChecksumGood) {
  if (test::output_of("tshark --version 2>/dev/null").empty()) GTEST_SKIP() << "needs tshark";
  CaptureWriter writer(file(), LinkKind::ethernet);
  writer.write(datagram(text("hi")));
  writer.close();
  EXPECT_EQ(
      test::output_of("tshark -r " + file().string() +
                      " -o ip.check_checksum:TRUE -T fields -e frame.time_epoch -e ip.src -e ip.dst"
                      " -e ip.checksum.status -e udp.srcport -e udp.dstport -e data.data"
                      " -E separator=, 2>/dev/null"),
      "1700000000.123456789,192.168.1.201,255.255.255.255,1,2368,8308,6869\n");
}

}  // namespace
}  // namespace convexcut::capture
