// SPDX-License-Identifier: Apache-2.0
#include "drivers/capture/capture_reader.hpp"

#include <array>
#include <limits>
#include <optional>
#include <utility>

#include <pcap/pcap.h>

#include "drivers/capture/network_frame.hpp"
#include "drivers/capture/open_input.hpp"

namespace convexcut::capture {
namespace {

constexpr const char* kSupportedLinks =
    "Ethernet (1), raw IP (101), Linux cooked (113, 276), USER0 (147, serial bytes) and SocketCAN "
    "(227)";

std::optional<LinkKind> link_kind(int data_link) noexcept {
  switch (data_link) {
    case DLT_EN10MB:
      return LinkKind::ethernet;
    case DLT_LINUX_SLL:
      return LinkKind::linux_cooked;
    case DLT_LINUX_SLL2:
      return LinkKind::linux_cooked2;
    case DLT_RAW:
      return LinkKind::raw_ip;
    case DLT_USER0:
      return LinkKind::serial;
    case DLT_CAN_SOCKETCAN:
      return LinkKind::can;
    default:
      return std::nullopt;
  }
}

std::string link_name(int data_link) {
  const char* name = ::pcap_datalink_val_to_name(data_link);
  const std::string number = std::to_string(data_link);
  return name != nullptr ? std::string(name) + " (" + number + ")" : number;
}

// libpcap hands out seconds and, as it was opened for it, nanoseconds.
std::optional<HostTime> host_time(const ::timeval& stamp) noexcept {
  std::int64_t seconds = stamp.tv_sec;
  // A pcap file's seconds are unsigned, libpcap reads them as signed: they go on until 2106.
  if (seconds < 0 && seconds >= std::numeric_limits<std::int32_t>::min()) {
    seconds += std::int64_t{1} << 32U;
  }
  const std::int64_t nanoseconds = stamp.tv_usec;
  std::int64_t total = 0;
  if (__builtin_mul_overflow(seconds, std::int64_t{1'000'000'000}, &total) ||
      __builtin_add_overflow(total, nanoseconds, &total)) {
    return std::nullopt;
  }
  return from_ns<HostTime>(total);
}

}  // namespace

void CaptureReader::Close::operator()(pcap* handle) const noexcept { ::pcap_close(handle); }

CaptureReader::CaptureReader(const std::filesystem::path& file)
    : CaptureReader(open_input(file, "a capture file"), file.string()) {}

CaptureReader::CaptureReader(std::FILE* stream, std::string name)
    : name_(std::move(name)), file_size_(size_of(stream)) {
  std::array<char, PCAP_ERRBUF_SIZE> error{};
  handle_.reset(
      ::pcap_fopen_offline_with_tstamp_precision(stream, PCAP_TSTAMP_PRECISION_NANO, error.data()));
  if (handle_ == nullptr) {
    const bool empty = std::feof(stream) != 0 && ::ftello(stream) == 0;
    static_cast<void>(std::fclose(stream));
    if (empty) throw CaptureError(name_ + ": is empty, expected a pcap or pcapng capture");
    throw CaptureError(name_ + ": not a pcap or pcapng capture: " + error.data());
  }
  const int data_link = ::pcap_datalink(handle_.get());
  const std::optional<LinkKind> kind = link_kind(data_link);
  if (!kind) {
    throw CaptureError(name_ + ": link type " + link_name(data_link) +
                       " is not supported, expected " + kSupportedLinks);
  }
  link_ = *kind;
}

ReadStatus CaptureReader::next(Record& record) noexcept {
  while (status_ == ReadStatus::record) {
    ::pcap_pkthdr* header = nullptr;
    const unsigned char* data = nullptr;
    const int result = ::pcap_next_ex(handle_.get(), &header, &data);
    if (result != 1) {
      status_ = stop_status(result);
      break;
    }
    ++read_;
    const std::optional<HostTime> stamp = host_time(header->ts);
    if (!stamp) {
      counters_.malformed.add();
      continue;
    }
    Record found;
    found.stamp = *stamp;
    const wire::Bytes captured(reinterpret_cast<const std::byte*>(data), header->caplen);
    if (!interpret(captured, header->caplen < header->len, found)) continue;
    if (found.stamp < latest_) counters_.backward_stamps.add();
    latest_ = found.stamp;
    counters_.records.add();
    record = found;
    return ReadStatus::record;
  }
  return status_;
}

// Whether the record is one to deliver; counts it otherwise.
bool CaptureReader::interpret(wire::Bytes captured, bool cut, Record& record) noexcept {
  if (link_ == LinkKind::serial || link_ == LinkKind::can) {
    if (cut) {
      counters_.truncated.add();
      return false;
    }
    record.kind = link_ == LinkKind::serial ? RecordKind::serial : RecordKind::can;
    record.payload = captured;
    return true;
  }
  switch (parse_frame(link_, {captured, cut}, record)) {
    case FrameVerdict::datagram:
      record.kind = RecordKind::datagram;
      counters_.datagrams.add();
      return true;
    case FrameVerdict::other:
      return true;
    case FrameVerdict::fragment:
      counters_.fragments.add();
      return false;
    case FrameVerdict::truncated:
      counters_.truncated.add();
      return false;
    case FrameVerdict::malformed:
      counters_.malformed.add();
      return false;
  }
  return false;
}

ReadStatus CaptureReader::stop_status(int result) const noexcept {
  if (result == PCAP_ERROR_BREAK) return ReadStatus::end;
  // libpcap has one code for every error. Of these only a file that stops too early runs into its
  // end.
  return std::feof(::pcap_file(handle_.get())) != 0 ? ReadStatus::truncated : ReadStatus::failed;
}

std::string CaptureReader::problem() const {
  if (status_ != ReadStatus::truncated && status_ != ReadStatus::failed) return {};
  const std::string place = name_ + ": record " + std::to_string(read_ + 1);
  if (status_ == ReadStatus::truncated) {
    return place + " is cut off by the end of the file; the records before it were read";
  }
  return place + " cannot be read: " + ::pcap_geterr(handle_.get());
}

std::uint64_t CaptureReader::bytes_read() const noexcept {
  const ::off_t position = ::ftello(::pcap_file(handle_.get()));
  return position > 0 ? static_cast<std::uint64_t>(position) : 0;
}

}  // namespace convexcut::capture
