// SPDX-License-Identifier: Apache-2.0
//
// A small capture of each format, cut at every byte. Does not prove anything about files that are
// damaged but complete: the fuzz target looks for crashes in those.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/capture/capture_reader.hpp"
#include "tests/drivers/capture/capture_bytes.hpp"

namespace convexcut::capture {
namespace {

using test::Octets;
using test::PcapBuilder;

constexpr std::size_t kFrameSize = 14 + 20 + 8 + 3;

Octets frame() {
  return test::ethernet(test::kEtherTypeIpv4, test::ipv4({.payload = test::text("abc")}));
}

CaptureReader open(Octets& bytes, std::size_t size) {
  return {::fmemopen(bytes.data(), size, "r"), "part.pcap"};
}

struct Outcome {
  std::uint64_t records = 0;
  ReadStatus status = ReadStatus::record;
  std::string problem;
};

Outcome read_all(CaptureReader& reader) {
  Outcome outcome;
  Record record;
  while ((outcome.status = reader.next(record)) == ReadStatus::record) {
    EXPECT_EQ(record.payload.size(), 3U);
    ++outcome.records;
  }
  outcome.problem = reader.problem();
  return outcome;
}

// Where each part of a file ends: its head, then its records.
void expect_every_cut_is_told(Octets bytes, std::size_t head,
                              const std::vector<std::size_t>& record_ends) {
  for (std::size_t size = 1; size <= bytes.size(); ++size) {
    if (size < head) {
      EXPECT_THROW(open(bytes, size), CaptureError) << size;
      continue;
    }
    CaptureReader reader = open(bytes, size);
    const Outcome outcome = read_all(reader);
    const auto whole = static_cast<std::uint64_t>(std::count_if(
        record_ends.begin(), record_ends.end(), [size](std::size_t end) { return end <= size; }));
    EXPECT_EQ(outcome.records, whole) << size;
    const bool at_boundary = size == head || std::find(record_ends.begin(), record_ends.end(),
                                                       size) != record_ends.end();
    EXPECT_EQ(outcome.status, at_boundary ? ReadStatus::end : ReadStatus::truncated) << size;
    EXPECT_EQ(outcome.problem,
              at_boundary
                  ? ""
                  : "part.pcap: record " + std::to_string(whole + 1) +
                        " is cut off by the end of the file; the records before it were read")
        << size;
  }
}

TEST(CaptureTruncation, PcapCutAtEveryByte) {
  constexpr std::size_t kHead = 24;
  constexpr std::size_t kRecord = 16 + kFrameSize;
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const Octets bytes = PcapBuilder(1, PcapBuilder::kNanoseconds, order)
                             .record(1, 0, frame())
                             .record(2, 0, frame())
                             .record(3, 0, frame())
                             .get();
    expect_every_cut_is_told(bytes, kHead,
                             {kHead + kRecord, kHead + 2 * kRecord, kHead + 3 * kRecord});
  }
}

TEST(CaptureTruncation, PcapngCutAtEveryByte) {
  constexpr std::size_t kHead = 28 + 32;
  constexpr std::size_t kRecord = 32 + kFrameSize + 3;
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const Octets bytes = test::pcapng(1, 9, 1'000'000'000, frame(), order);
    expect_every_cut_is_told(bytes, kHead, {kHead + kRecord});
  }
}

TEST(CaptureTruncation, AnswerStaysAndTheRecordIsLeftAlone) {
  Octets bytes = PcapBuilder(1).record(1, 0, frame()).get();
  CaptureReader reader = open(bytes, bytes.size() - 1);
  Record record;
  record.source_port = 77;
  EXPECT_EQ(reader.next(record), ReadStatus::truncated);
  EXPECT_EQ(reader.next(record), ReadStatus::truncated);
  EXPECT_EQ(record.source_port, 77);
}

}  // namespace
}  // namespace convexcut::capture
