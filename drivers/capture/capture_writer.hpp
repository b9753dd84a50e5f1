// SPDX-License-Identifier: Apache-2.0
//
// Writes pcap files with nanosecond stamps, that CaptureReader and Wireshark read.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "drivers/capture/capture_error.hpp"
#include "drivers/capture/record.hpp"

struct pcap;
struct pcap_dumper;

namespace convexcut::capture {

// The file is "<name>.part" until close() has put everything on the disk and renamed it, so that a
// file of the final name is always whole. One thread.
class CaptureWriter {
 public:
  // `link` is ethernet, serial or can. Throws CaptureError when the file cannot be made, and
  // std::invalid_argument for the other links.
  CaptureWriter(std::filesystem::path file, LinkKind link);
  // Without a close() nothing remains.
  ~CaptureWriter();
  CaptureWriter(const CaptureWriter&) = delete;
  CaptureWriter& operator=(const CaptureWriter&) = delete;

  // Appends a record of the link's kind. A datagram gets Ethernet (broadcast), IPv4 and UDP
  // (without checksum, as RFC 768 permits) headers. Throws CaptureError when it cannot be written
  // (disk full), and std::invalid_argument for a record of another kind, a datagram without IPv4
  // addresses or of more than 65507 bytes, and a stamp outside 1970 … 2106.
  void write(const Record& record);

  // Throws CaptureError, as write(). Must be the last call.
  void close();

 private:
  struct CloseHandle {
    void operator()(pcap* handle) const noexcept;
  };
  struct CloseDumper {
    void operator()(pcap_dumper* dumper) const noexcept;
  };

  void frame_datagram(const Record& record);
  [[noreturn]] void fail(const char* action);

  std::filesystem::path file_;
  std::filesystem::path part_;
  LinkKind link_;
  std::unique_ptr<pcap, CloseHandle> handle_;
  std::unique_ptr<pcap_dumper, CloseDumper> dumper_;
  std::vector<std::byte> frame_;
};

}  // namespace convexcut::capture
