// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as a capture file. Beyond not crashing: payloads lie in memory that may be read, every
// record is counted once, an end is final, and errors are one line.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "drivers/capture/capture_reader.hpp"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

bool is_one_line(const std::string& text) { return text.find('\n') == std::string::npos; }

void read_all(convexcut::capture::CaptureReader& reader) {
  using convexcut::capture::ReadStatus;
  convexcut::capture::Record record;
  std::uint64_t records = 0;
  unsigned sum = 0;
  while (reader.next(record) == ReadStatus::record) {
    ++records;
    for (const std::byte b : record.payload) sum += std::to_integer<unsigned>(b);
  }
  volatile unsigned sink = sum;
  static_cast<void>(sink);
  require(records == reader.counters().records.value());
  const ReadStatus status = reader.next(record);
  require(status != ReadStatus::record);
  require(reader.problem().empty() == (status == ReadStatus::end));
  require(is_one_line(reader.problem()));
  require(reader.bytes_read() <= reader.file_size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> bytes(data, data + size);
  std::FILE* stream = ::fmemopen(bytes.data(), bytes.size(), "r");
  if (stream == nullptr) return 0;
  try {
    convexcut::capture::CaptureReader reader(stream, "fuzz");
    read_all(reader);
  } catch (const convexcut::capture::CaptureError& error) {
    require(is_one_line(error.what()));
  }
  return 0;
}
