// SPDX-License-Identifier: Apache-2.0
//
// Reads pcap and pcapng files, of either byte order, with microsecond or nanosecond stamps. Memory
// does not grow with the file. One thread; the counters may be read from others.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "core/counter.hpp"
#include "drivers/capture/capture_error.hpp"
#include "drivers/capture/record.hpp"
#include "drivers/wire.hpp"

struct pcap;  // libpcap's handle

namespace convexcut::capture {

struct CaptureCounters {
  Counter records;          // delivered, of any kind
  Counter datagrams;        // delivered as RecordKind::datagram
  Counter fragments;        // parts of fragmented datagrams: skipped
  Counter truncated;        // records of which the capture kept too little: skipped
  Counter malformed;        // records that contradict themselves: skipped
  Counter backward_stamps;  // delivered records that are older than the one before
};

class CaptureReader {
 public:
  // Throws CaptureError when the file is missing, empty, not a capture or of an unsupported link.
  explicit CaptureReader(const std::filesystem::path& file);
  // Takes the stream over, also when it throws; `name` stands for the file in messages.
  CaptureReader(std::FILE* stream, std::string name);

  [[nodiscard]] LinkKind link() const noexcept { return link_; }

  // The next record, in file order with its stamp as it is. The payload is valid until the next
  // call. Once it is anything but ReadStatus::record, the answer stays and `record` is untouched.
  [[nodiscard]] ReadStatus next(Record& record) noexcept;

  // One line that says what is wrong after ReadStatus::truncated or ::failed, otherwise empty.
  [[nodiscard]] std::string problem() const;

  [[nodiscard]] std::uint64_t bytes_read() const noexcept;
  // 0 when the input is not a regular file.
  [[nodiscard]] std::uint64_t file_size() const noexcept { return file_size_; }
  [[nodiscard]] const CaptureCounters& counters() const noexcept { return counters_; }

 private:
  struct Close {
    void operator()(pcap* handle) const noexcept;
  };

  [[nodiscard]] ReadStatus stop_status(int result) const noexcept;
  [[nodiscard]] bool interpret(wire::Bytes captured, bool cut, Record& record) noexcept;

  std::string name_;
  std::unique_ptr<pcap, Close> handle_;
  std::uint64_t file_size_ = 0;
  std::uint64_t read_ = 0;  // records taken from the file, delivered or not
  HostTime latest_{HostTime::min()};
  LinkKind link_ = LinkKind::ethernet;
  ReadStatus status_ = ReadStatus::record;
  CaptureCounters counters_;
};

}  // namespace convexcut::capture
