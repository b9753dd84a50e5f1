// SPDX-License-Identifier: Apache-2.0
//
// Files of every format and link, and the errors of opening. Does not prove that memory stays
// constant over long files, nor files beyond 2 GiB.
#include "drivers/capture/capture_reader.hpp"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/drivers/capture/capture_bytes.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::capture {
namespace {

using test::ethernet;
using test::ipv4;
using test::kEtherTypeIpv4;
using test::Octets;
using test::OctetWriter;
using test::PcapBuilder;
using test::text;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

constexpr std::uint32_t kEthernet = 1;
constexpr std::uint32_t kRawIp = 101;
constexpr std::uint32_t kLinuxCooked = 113;
constexpr std::uint32_t kUser0 = 147;
constexpr std::uint32_t kSocketCan = 227;
constexpr std::uint32_t kLinuxCooked2 = 276;

class CaptureFile : public ::testing::Test {
 protected:
  std::filesystem::path file(const Octets& bytes) {
    const std::filesystem::path path = folder_.path() / "trip.pcap";
    test::write_file(path, bytes);
    return path;
  }

  static std::string error_of(const std::filesystem::path& path) {
    try {
      const CaptureReader reader(path);
    } catch (const CaptureError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      EXPECT_THAT(error.what(), HasSubstr(path.string()));
      return error.what();
    }
    ADD_FAILURE() << "opened " << path;
    return {};
  }

  test::TemporaryDirectory folder_;
};

Octets hello_frame() { return ethernet(kEtherTypeIpv4, ipv4({.payload = text("hello")})); }

// The only record of a capture must be the datagram "hello" of this time.
void expect_hello(const std::filesystem::path& file, std::int64_t stamp_ns) {
  CaptureReader reader(file);
  Record record;
  ASSERT_EQ(reader.next(record), ReadStatus::record);
  EXPECT_EQ(record.kind, RecordKind::datagram);
  EXPECT_EQ(to_ns(record.stamp), stamp_ns);
  EXPECT_THAT(record.payload, ElementsAreArray(text("hello")));
  EXPECT_EQ(reader.next(record), ReadStatus::end);
  EXPECT_EQ(reader.problem(), "");
}

struct Format {
  const char* name;
  std::uint32_t magic;
  std::endian order;
  std::int64_t unit_ns;
};

class PcapFormat : public CaptureFile, public ::testing::WithParamInterface<Format> {};

TEST_P(PcapFormat, StampsAreExact) {
  const Format format = GetParam();
  const Octets bytes = PcapBuilder(kEthernet, format.magic, format.order)
                           .record(1319768048, 284'089, hello_frame())
                           .get();
  expect_hello(file(bytes), 1319768048'000'000'000 + 284'089 * format.unit_ns);
}

INSTANTIATE_TEST_SUITE_P(
    , PcapFormat,
    ::testing::Values(
        Format{"MicrosecondsLittle", PcapBuilder::kMicroseconds, std::endian::little, 1000},
        Format{"MicrosecondsBig", PcapBuilder::kMicroseconds, std::endian::big, 1000},
        Format{"NanosecondsLittle", PcapBuilder::kNanoseconds, std::endian::little, 1},
        Format{"NanosecondsBig", PcapBuilder::kNanoseconds, std::endian::big, 1}),
    [](const auto& test) { return std::string(test.param.name); });

TEST_F(CaptureFile, PcapngOfBothByteOrdersAndResolutions) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    expect_hello(file(test::pcapng(kEthernet, 9, 1'700'000'000'123'456'789, hello_frame(), order)),
                 1'700'000'000'123'456'789);
    expect_hello(file(test::pcapng(kEthernet, 6, 1'700'000'000'123'456, hello_frame(), order)),
                 1'700'000'000'123'456'000);
  }
}

TEST_F(CaptureFile, SecondsGoOnAfter2038) {
  const Octets bytes = PcapBuilder(kEthernet).record(0xF0000000, 1, hello_frame()).get();
  expect_hello(file(bytes), 0xF0000000LL * 1'000'000'000 + 1000);
}

TEST_F(CaptureFile, StampBeyondTheTimeTypeIsMalformed) {
  // Whole seconds (if_tsresol 0) of 64 bits.
  CaptureReader reader(
      file(test::pcapng(kEthernet, 0, 1ULL << 60U, hello_frame(), std::endian::little)));
  Record record;
  EXPECT_EQ(reader.next(record), ReadStatus::end);
  EXPECT_EQ(reader.counters().malformed.value(), 1U);
}

TEST_F(CaptureFile, LinuxCookedAndRawIpLinks) {
  const Octets packet = ipv4({.payload = text("hello")});
  expect_hello(
      file(
          PcapBuilder(kLinuxCooked).record(7, 0, test::linux_cooked(kEtherTypeIpv4, packet)).get()),
      7'000'000'000);
  expect_hello(file(PcapBuilder(kLinuxCooked2)
                        .record(7, 0, test::linux_cooked2(kEtherTypeIpv4, packet))
                        .get()),
               7'000'000'000);
  expect_hello(file(PcapBuilder(kRawIp).record(7, 0, packet).get()), 7'000'000'000);
}

TEST_F(CaptureFile, SerialBytesAreHandedOnAsRead) {
  CaptureReader reader(file(PcapBuilder(kUser0).record(1, 2, text("\xFA\xFF")).get()));
  EXPECT_EQ(reader.link(), LinkKind::serial);
  Record record;
  ASSERT_EQ(reader.next(record), ReadStatus::record);
  EXPECT_EQ(record.kind, RecordKind::serial);
  EXPECT_EQ(to_ns(record.stamp), 1'000'002'000);
  EXPECT_THAT(record.payload, ElementsAreArray(text("\xFA\xFF")));
}

TEST_F(CaptureFile, CanFramesAreHandedOnRaw) {
  const Octets frame = test::hex("00 00 00 34 06 00 00 00  00 00 00 00 09 CF");
  CaptureReader reader(file(PcapBuilder(kSocketCan).record(1, 0, frame).get()));
  EXPECT_EQ(reader.link(), LinkKind::can);
  Record record;
  ASSERT_EQ(reader.next(record), ReadStatus::record);
  EXPECT_EQ(record.kind, RecordKind::can);
  EXPECT_THAT(record.payload, ElementsAreArray(frame));
}

TEST_F(CaptureFile, SerialAndCanRecordsCutBySnapshotLengthAreSkipped) {
  for (const std::uint32_t link : {kUser0, kSocketCan}) {
    CaptureReader reader(file(PcapBuilder(link).cut_record(text("part"), 100).get()));
    Record record;
    EXPECT_EQ(reader.next(record), ReadStatus::end);
    EXPECT_EQ(reader.counters().truncated.value(), 1U);
  }
}

TEST_F(CaptureFile, UnusableFramesAreCountedByReasonAndSkipped) {
  const Octets frame = hello_frame();
  Octets malformed = frame;
  malformed[14] = std::byte{0x41};
  const Octets fragment = ethernet(kEtherTypeIpv4, ipv4({.payload = text("half")}, {}, 0x2000));
  const Octets cut(frame.begin(), frame.end() - 1);
  CaptureReader reader(file(PcapBuilder(kEthernet)
                                .record(1, 0, malformed)
                                .record(1, 0, fragment)
                                .cut_record(cut, frame.size())
                                .record(2, 0, frame)
                                .get()));
  Record record;
  ASSERT_EQ(reader.next(record), ReadStatus::record);
  EXPECT_EQ(to_ns(record.stamp), 2'000'000'000);
  EXPECT_EQ(reader.next(record), ReadStatus::end);
  EXPECT_EQ(reader.counters().malformed.value(), 1U);
  EXPECT_EQ(reader.counters().fragments.value(), 1U);
  EXPECT_EQ(reader.counters().truncated.value(), 1U);
  EXPECT_EQ(reader.counters().datagrams.value(), 1U);
  EXPECT_EQ(reader.counters().records.value(), 1U);
}

TEST_F(CaptureFile, CaptureWithoutUdpDeliversOtherRecordsWithoutPayload) {
  CaptureReader reader(
      file(PcapBuilder(kEthernet).record(3, 0, ethernet(0x0806, Octets(28))).get()));
  Record record;
  ASSERT_EQ(reader.next(record), ReadStatus::record);
  EXPECT_EQ(record.kind, RecordKind::other);
  EXPECT_TRUE(record.payload.empty());
  EXPECT_EQ(reader.next(record), ReadStatus::end);
  EXPECT_EQ(reader.counters().records.value(), 1U);
  EXPECT_EQ(reader.counters().datagrams.value(), 0U);
}

TEST_F(CaptureFile, BackwardStampsAreDeliveredAndCounted) {
  CaptureReader reader(file(PcapBuilder(kEthernet)
                                .record(5, 0, hello_frame())
                                .record(4, 999'999, hello_frame())
                                .record(4, 999'999, hello_frame())
                                .get()));
  Record record;
  for (const std::int64_t ns : {5'000'000'000, 4'999'999'000, 4'999'999'000}) {
    ASSERT_EQ(reader.next(record), ReadStatus::record);
    EXPECT_EQ(to_ns(record.stamp), ns);
  }
  EXPECT_EQ(reader.counters().backward_stamps.value(), 1U);
}

TEST_F(CaptureFile, CaptureWithoutRecordsEndsAtOnce) {
  CaptureReader reader(file(PcapBuilder(kEthernet).get()));
  Record record;
  EXPECT_EQ(reader.next(record), ReadStatus::end);
  EXPECT_EQ(reader.next(record), ReadStatus::end);
}

TEST_F(CaptureFile, ProgressIsReportedInBytes) {
  const Octets bytes = PcapBuilder(kEthernet).record(5, 0, hello_frame()).get();
  CaptureReader reader(file(bytes));
  EXPECT_EQ(reader.file_size(), bytes.size());
  EXPECT_EQ(reader.bytes_read(), 24U);
  Record record;
  ASSERT_EQ(reader.next(record), ReadStatus::record);
  EXPECT_EQ(reader.bytes_read(), bytes.size());
}

TEST_F(CaptureFile, DamageInsideStopsReadingAndSaysWhere) {
  OctetWriter damaged = PcapBuilder(kEthernet).record(5, 0, hello_frame()).out;
  damaged.u32(6).u32(0).u32(0xFFFFFFFF).u32(0xFFFFFFFF).zeros(100);
  CaptureReader reader(file(damaged.get()));
  Record record;
  ASSERT_EQ(reader.next(record), ReadStatus::record);
  EXPECT_EQ(reader.next(record), ReadStatus::failed);
  EXPECT_THAT(reader.problem(), HasSubstr("trip.pcap: record 2 cannot be read: "));
  EXPECT_EQ(reader.next(record), ReadStatus::failed);
}

TEST_F(CaptureFile, MissingFileIsAnError) {
  EXPECT_THAT(error_of(folder_.path() / "none.pcap"), HasSubstr("No such file"));
}

TEST_F(CaptureFile, DirectoryIsAnError) {
  EXPECT_THAT(error_of(folder_.path()), HasSubstr("is a directory"));
}

TEST_F(CaptureFile, EmptyFileIsAnError) { EXPECT_THAT(error_of(file({})), HasSubstr("is empty")); }

TEST_F(CaptureFile, OtherFileIsAnError) {
  EXPECT_THAT(error_of(file(text("VERSION 0.7\nFIELDS x y z intensity\n"))),
              HasSubstr("not a pcap or pcapng capture"));
}

TEST_F(CaptureFile, UnsupportedLinkIsNamedWithTheSupportedOnes) {
  const std::string error = error_of(file(PcapBuilder(105).get()));
  EXPECT_THAT(error, HasSubstr("link type IEEE802_11 (105) is not supported"));
  EXPECT_THAT(error, HasSubstr("Ethernet (1)"));
  EXPECT_THAT(error, HasSubstr("SocketCAN (227)"));
}

TEST_F(CaptureFile, PcapngWithoutAnInterfaceIsAnError) {
  Octets bytes = test::pcapng(kEthernet, 6, 0, {}, std::endian::little);
  bytes.resize(28);
  EXPECT_THAT(error_of(file(bytes)), HasSubstr("not a pcap or pcapng capture"));
}

std::map<std::uint16_t, int> datagrams_by_port(CaptureReader& reader) {
  std::map<std::uint16_t, int> count;
  Record record;
  while (reader.next(record) == ReadStatus::record) {
    if (record.kind == RecordKind::datagram) ++count[record.destination_port];
  }
  return count;
}

TEST(Recording, Hdl32eCourtyardHoldsFiveHundredDataPackets) {
  CONVEXCUT_NEEDS_RECORDING(path, "lidar/hdl32e_courtyard_2011.pcap");
  CaptureReader reader(path);
  EXPECT_EQ(datagrams_by_port(reader), (std::map<std::uint16_t, int>{{2368, 500}}));
}

TEST(Recording, Vlp16HoldsDataAndPositionPackets) {
  CONVEXCUT_NEEDS_RECORDING(path, "lidar/vlp16_gps_2016.pcap");
  CaptureReader reader(path);
  EXPECT_EQ(datagrams_by_port(reader), (std::map<std::uint16_t, int>{{2368, 293}, {8308, 57}}));
}

TEST(Recording, StampsAndEndpointsAreThoseOfOtherTools) {
  CONVEXCUT_NEEDS_RECORDING(path, "lidar/hdl32e_courtyard_2011.pcap");
  CaptureReader reader(path);
  Record record;
  ASSERT_EQ(reader.next(record), ReadStatus::record);
  // capinfos, tcpdump -n.
  EXPECT_EQ(to_ns(record.stamp), 1'319'768'048'284'089'000);
  EXPECT_EQ(record.source, Ipv4Address::from_octets(192, 168, 17, 162));
  EXPECT_EQ(record.destination, Ipv4Address::from_octets(192, 168, 3, 255));
  EXPECT_EQ(record.source_port, 443);
  EXPECT_EQ(record.payload.size(), 1206U);
}

}  // namespace
}  // namespace convexcut::capture
