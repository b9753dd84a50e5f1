// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

#include "drivers/capture/capture_reader.hpp"

namespace convexcut::recorder::testing {

inline constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;

// Bytes and records that follow from a number.
inline std::vector<std::byte> payload_of(std::uint64_t number, std::size_t size) {
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(number + i);
  return bytes;
}
inline capture::Record datagram(std::uint64_t number, const std::vector<std::byte>& payload) {
  return {.stamp = from_ns<HostTime>(kStartNs + static_cast<std::int64_t>(number) * 553'001),
          .kind = capture::RecordKind::datagram,
          .source_port = 2368,
          .destination_port = 2368,
          .source = Ipv4Address::from_octets(192, 168, 1, 201),
          .destination = Ipv4Address::from_octets(192, 168, 1, 77),
          .payload = payload};
}
inline capture::Record read_of(std::uint64_t number, const std::vector<std::byte>& payload) {
  return {.stamp = from_ns<HostTime>(kStartNs + static_cast<std::int64_t>(number) * 2'500'001),
          .kind = capture::RecordKind::serial,
          .payload = payload};
}

// What a file holds: how many records, and how the reading ended. Every record must follow the one
// before in number (by its stamp) and have that number's bytes.
struct FileContent {
  std::uint64_t records = 0;
  std::uint64_t first = 0;
  std::uint64_t wrong = 0;
  capture::ReadStatus end = capture::ReadStatus::record;
};
inline FileContent content_of(const std::filesystem::path& file, std::int64_t step_ns = 553'001) {
  FileContent content;
  capture::CaptureReader reader(file);
  capture::Record record;
  while ((content.end = reader.next(record)) == capture::ReadStatus::record) {
    const auto number = static_cast<std::uint64_t>((to_ns(record.stamp) - kStartNs) / step_ns);
    if (content.records == 0) content.first = number;
    const std::vector<std::byte> expected = payload_of(number, record.payload.size());
    const bool whole = std::equal(expected.begin(), expected.end(), record.payload.begin());
    if (!whole || number != content.first + content.records) ++content.wrong;
    ++content.records;
  }
  return content;
}

}  // namespace convexcut::recorder::testing
