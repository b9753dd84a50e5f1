// SPDX-License-Identifier: Apache-2.0
//
// Writes pcap files with nanosecond stamps, that CaptureReader and Wireshark read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "drivers/capture/capture_error.hpp"
#include "drivers/capture/record.hpp"

struct pcap;
struct pcap_dumper;

namespace convexcut::capture {

// When the file gets its name.
enum class Appears : std::uint8_t {
  // By close(), which has put everything on the disk: until then it is "<name>.part", which a
  // failure removes. A file of the final name is always whole.
  whole,
  // At once, and it stays, whatever happens: what was flushed can be read even if the program is
  // killed or the disk gets full, when the file may end inside a record. An existing file is never
  // overwritten.
  at_once,
};

// One thread.
class CaptureWriter {
 public:
  // `link` is ethernet, serial or can. Throws CaptureError when the file cannot be made, and
  // std::invalid_argument for the other links.
  CaptureWriter(std::filesystem::path file, LinkKind link, Appears appears = Appears::whole);
  // Without a close(): nothing remains of Appears::whole, all that was written of Appears::at_once.
  ~CaptureWriter();
  CaptureWriter(const CaptureWriter&) = delete;
  CaptureWriter& operator=(const CaptureWriter&) = delete;

  // Appends a record of the link's kind. A datagram gets Ethernet (broadcast), IPv4 and UDP
  // (without checksum, as RFC 768 permits) headers. Throws CaptureError when it cannot be written
  // (disk full), and std::invalid_argument for a record of another kind, a datagram without IPv4
  // addresses or of more than 65507 bytes, and a stamp outside 1970 … 2106.
  void write(const Record& record);

  // Puts on the disk what was written so far: it survives the program's and the machine's death.
  // Throws CaptureError, as write().
  void flush();

  // Throws CaptureError, as write(). Must be the last call.
  void close();

  // Of the file, with what is not flushed yet.
  [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }
  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }

 private:
  struct CloseHandle {
    void operator()(pcap* handle) const noexcept;
  };
  struct CloseDumper {
    void operator()(pcap_dumper* dumper) const noexcept;
  };

  void frame_datagram(const Record& record);
  void abandon() noexcept;
  [[noreturn]] void fail(const char* action);

  std::filesystem::path file_;
  std::filesystem::path part_;  // what the file is called now
  LinkKind link_;
  Appears appears_;
  std::uint64_t bytes_ = 0;
  std::unique_ptr<pcap, CloseHandle> handle_;
  std::unique_ptr<pcap_dumper, CloseDumper> dumper_;
  std::vector<std::byte> frame_;
};

}  // namespace convexcut::capture
