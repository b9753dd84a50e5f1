// SPDX-License-Identifier: Apache-2.0
#include "drivers/capture/capture_writer.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include <pcap/pcap.h>
#include <system_error>
#include <unistd.h>

#include "drivers/capture/wire_layout.hpp"
#include "drivers/wire.hpp"

namespace convexcut::capture {
namespace {

constexpr int kSnapshotLength = 262'144;  // libpcap's largest for these links
constexpr std::size_t kWriteSize = 65'536;
constexpr std::uint64_t kFileHeader = 24;
constexpr std::uint64_t kRecordHeader = 16;
constexpr std::size_t kDatagramHeaders =
    ethernet::kHeaderSize + ipv4::kMinHeaderSize + udp::kHeaderSize;
constexpr std::size_t kMacSize = ethernet::kSource - ethernet::kDestination;
// A locally administered address: it can be no real device's.
constexpr std::array<std::uint8_t, kMacSize> kSourceMac{0x02, 0x00, 0x00, 0x00, 0x00, 0x01};
constexpr std::uint8_t kVersion4With5Words = 0x45;
constexpr std::uint8_t kTimeToLive = 64;

int data_link(LinkKind link) {
  switch (link) {
    case LinkKind::ethernet:
      return DLT_EN10MB;
    case LinkKind::serial:
      return DLT_USER0;
    case LinkKind::can:
      return DLT_CAN_SOCKETCAN;
    case LinkKind::linux_cooked:
    case LinkKind::linux_cooked2:
    case LinkKind::raw_ip:
      break;
  }
  throw std::invalid_argument("captures are written as Ethernet, serial or CAN");
}

RecordKind kind_of(LinkKind link) noexcept {
  if (link == LinkKind::serial) return RecordKind::serial;
  return link == LinkKind::can ? RecordKind::can : RecordKind::datagram;
}

template <std::unsigned_integral T>
void store_be(std::span<std::byte> bytes, std::size_t offset, T value) noexcept {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bytes[offset + i] = static_cast<std::byte>(value >> (8 * (sizeof(T) - 1 - i)));
  }
}

// RFC 1071, over a header whose checksum field is still zero.
std::uint16_t internet_checksum(wire::Bytes header) noexcept {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i + 1 < header.size(); i += 2) {
    sum += wire::load_be<std::uint16_t>(header, i);
  }
  while (sum >> 16U != 0) sum = (sum & 0xFFFFU) + (sum >> 16U);
  return static_cast<std::uint16_t>(~sum);
}

::timeval capture_stamp(HostTime stamp) {
  const std::int64_t ns = to_ns(stamp);
  constexpr std::int64_t kSecond = 1'000'000'000;
  if (ns < 0 || ns / kSecond > std::numeric_limits<std::uint32_t>::max()) {
    throw std::invalid_argument("a capture holds stamps of 1970 to 2106, found " +
                                std::to_string(ns) + " ns");
  }
  return {.tv_sec = ns / kSecond, .tv_usec = ns % kSecond};
}

}  // namespace

void CaptureWriter::CloseHandle::operator()(pcap* handle) const noexcept { ::pcap_close(handle); }
void CaptureWriter::CloseDumper::operator()(pcap_dumper* dumper) const noexcept {
  ::pcap_dump_close(dumper);
}

CaptureWriter::CaptureWriter(std::filesystem::path file, LinkKind link, Appears appears)
    : file_(std::move(file)),
      part_(appears == Appears::whole ? file_.string() + ".part" : file_.string()),
      link_(link),
      appears_(appears),
      bytes_(kFileHeader),
      handle_(::pcap_open_dead_with_tstamp_precision(data_link(link), kSnapshotLength,
                                                     PCAP_TSTAMP_PRECISION_NANO)) {
  if (handle_ == nullptr) throw CaptureError(file_.string() + ": out of memory");
  std::FILE* stream = std::fopen(part_.c_str(), appears == Appears::whole ? "wbe" : "wbex");
  if (stream == nullptr) {
    throw CaptureError(part_.string() + ": cannot create: " + std::strerror(errno));
  }
  static_cast<void>(std::setvbuf(stream, nullptr, _IOFBF, kWriteSize));
  dumper_.reset(::pcap_dump_fopen(handle_.get(), stream));
  if (dumper_ == nullptr) {
    static_cast<void>(std::fclose(stream));
    fail("write");
  }
}

CaptureWriter::~CaptureWriter() {
  if (dumper_ != nullptr) abandon();
}

void CaptureWriter::abandon() noexcept {
  dumper_.reset();
  if (appears_ == Appears::at_once) return;
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void CaptureWriter::write(const Record& record) {
  if (record.kind != kind_of(link_)) {
    throw std::invalid_argument(file_.string() + ": a record of another kind than the capture");
  }
  wire::Bytes bytes = record.payload;
  if (record.kind == RecordKind::datagram) {
    frame_datagram(record);
    bytes = frame_;
  }
  const auto size = static_cast<bpf_u_int32>(bytes.size());
  const ::pcap_pkthdr header{.ts = capture_stamp(record.stamp), .caplen = size, .len = size};
  ::pcap_dump(reinterpret_cast<unsigned char*>(dumper_.get()), &header,
              reinterpret_cast<const unsigned char*>(bytes.data()));
  if (std::ferror(::pcap_dump_file(dumper_.get())) != 0) fail("write");
  bytes_ += kRecordHeader + size;
}

void CaptureWriter::frame_datagram(const Record& record) {
  if (!record.source || !record.destination || record.payload.size() > udp::kMaxPayload) {
    throw std::invalid_argument(file_.string() +
                                ": not a datagram of IPv4 addresses and at most 65507 bytes");
  }
  frame_.assign(kDatagramHeaders + record.payload.size(), std::byte{0});
  const std::span<std::byte> frame(frame_);
  std::ranges::fill(frame.subspan(ethernet::kDestination, kMacSize), std::byte{0xFF});
  std::ranges::transform(kSourceMac, frame.subspan(ethernet::kSource).begin(),
                         [](std::uint8_t octet) { return std::byte{octet}; });
  store_be(frame, ethernet::kEtherType, ethernet::kIpv4);

  const std::span<std::byte> ip = frame.subspan(ethernet::kHeaderSize);
  store_be(ip, ipv4::kVersionAndHeaderWords, kVersion4With5Words);
  store_be(ip, ipv4::kTotalLength, static_cast<std::uint16_t>(ip.size()));
  store_be(ip, ipv4::kTimeToLive, kTimeToLive);
  store_be(ip, ipv4::kProtocol, udp::kProtocol);
  store_be(ip, ipv4::kSource, record.source->value);
  store_be(ip, ipv4::kDestination, record.destination->value);
  store_be(ip, ipv4::kChecksum, internet_checksum(ip.first(ipv4::kMinHeaderSize)));

  const std::span<std::byte> datagram = ip.subspan(ipv4::kMinHeaderSize);
  store_be(datagram, udp::kSourcePort, record.source_port);
  store_be(datagram, udp::kDestinationPort, record.destination_port);
  store_be(datagram, udp::kLength, static_cast<std::uint16_t>(datagram.size()));
  std::ranges::copy(record.payload, datagram.subspan(udp::kHeaderSize).begin());
}

void CaptureWriter::flush() {
  if (::pcap_dump_flush(dumper_.get()) != 0) fail("write");
  // EINVAL: not a file on a disk.
  if (::fsync(::fileno(::pcap_dump_file(dumper_.get()))) != 0 && errno != EINVAL) fail("write");
}

void CaptureWriter::close() {
  flush();
  dumper_.reset();
  if (appears_ == Appears::at_once) return;
  std::error_code error;
  std::filesystem::rename(part_, file_, error);
  if (error) {
    throw CaptureError(file_.string() + ": cannot rename " + part_.string() +
                       " to it: " + error.message());
  }
}

void CaptureWriter::fail(const char* action) {
  const std::string reason = std::strerror(errno);
  abandon();
  throw CaptureError(part_.string() + ": cannot " + action + ": " + reason);
}

}  // namespace convexcut::capture
