// SPDX-License-Identifier: Apache-2.0
#include "replay/scan_writer.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace convexcut::replay {
namespace {

static_assert(std::endian::native == std::endian::little, "PCD and PLY records are little-endian");

// One point of a binary PCD or PLY file: packed, in the order of the fields.
constexpr std::size_t kPointBytes = 3 * sizeof(float) + 1 + 2 + 4 + 1;

// A whole HDL-32E revolution at 10 Hz and more; untouched memory costs nothing.
constexpr std::size_t kUsualScanBytes = 100'000 * kPointBytes;

template <class T>
char* put(char* to, T value) noexcept {
  std::memcpy(to, &value, sizeof value);
  return to + sizeof value;
}

std::filesystem::path make_directory(std::filesystem::path directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) {
    throw std::runtime_error("cannot make the output directory " + directory.string() + ": " +
                             error.message());
  }
  return directory;
}

template <class Number>
void append_number(Workspace<char>& text, Number value) {
  std::array<char, 32> digits{};
  // Shortest form that reads back as the same value; no locale.
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.insert(text.end(), digits.data(), end);
}

void append_text(Workspace<char>& to, std::string_view text) {
  to.insert(to.end(), text.begin(), text.end());
}

// Comment lines that say what the fields cannot: the stamp, and what is missing.
std::string remarks(const LevelledScan& scan, std::string_view mark) {
  std::array<char, 256> line{};
  std::snprintf(line.data(), line.size(),
                "%.*s stamp_ns %lld coverage %.4f dropped_no_orientation %u overflow_returns %u\n",
                static_cast<int>(mark.size()), mark.data(),
                static_cast<long long>(to_ns(scan.stamp)), scan.coverage,
                scan.dropped_no_orientation, scan.overflow_returns);
  return line.data();
}

// Points are relative to the lidar, in axes of the world: viewers put them where they belong.
std::string position_text(const LevelledScan& scan) {
  if (!scan.position_m) return "0 0 0";
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), "%.6f %.6f %.6f", scan.position_m->x(),
                scan.position_m->y(), scan.position_m->z());
  return text.data();
}

std::string pcd_header(const LevelledScan& scan) {
  const std::string count = std::to_string(scan.size());
  return "# .PCD v0.7 - Point Cloud Data file format\n" + remarks(scan, "#") +
         "VERSION 0.7\n"
         "FIELDS x y z intensity ring time label\n"
         "SIZE 4 4 4 1 2 4 1\n"
         "TYPE F F F U U U U\n"
         "COUNT 1 1 1 1 1 1 1\n"
         "WIDTH " +
         count + "\nHEIGHT 1\nVIEWPOINT " + position_text(scan) + " 1 0 0 0\nPOINTS " + count +
         "\nDATA binary\n";
}

std::string ply_header(const LevelledScan& scan) {
  return "ply\nformat binary_little_endian 1.0\n" + remarks(scan, "comment") + "element vertex " +
         std::to_string(scan.size()) +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar intensity\n"
         "property ushort ring\nproperty uint time\nproperty uchar label\nend_header\n";
}

}  // namespace

std::string_view extension(ScanFormat format) noexcept {
  switch (format) {
    case ScanFormat::pcd:
      return "pcd";
    case ScanFormat::ply:
      return "ply";
    case ScanFormat::csv:
      return "csv";
  }
  return "";
}

ScanWriter::ScanWriter(std::filesystem::path directory, ScanFormat format)
    : directory_(make_directory(std::move(directory))),
      format_(format),
      index_(directory_ / "scans.csv") {
  index_.write("index,stamp_ns,points,structure,coverage,latency_us\n");
  buffer_.reserve(kUsualScanBytes);
}

std::filesystem::path ScanWriter::scan_path(std::uint64_t index) const {
  std::array<char, 48> name{};
  std::snprintf(name.data(), name.size(), "scan_%06llu.%s", static_cast<unsigned long long>(index),
                extension(format_).data());
  return directory_ / name.data();
}

void ScanWriter::write(const LevelledScan& scan, Duration latency) {
  buffer_.clear();
  append_header(scan);
  if (format_ == ScanFormat::csv) {
    append_text_points(scan);
  } else {
    append_binary_points(scan);
  }
  AtomicFile file(scan_path(scan.index));
  file.write({buffer_.data(), buffer_.size()});
  file.commit();

  std::array<char, 160> row{};
  std::snprintf(row.data(), row.size(), "%llu,%lld,%zu,%u,%.4f,%lld\n",
                static_cast<unsigned long long>(scan.index),
                static_cast<long long>(to_ns(scan.stamp)), scan.size(), scan.structure_points,
                scan.coverage,
                static_cast<long long>(
                    std::chrono::duration_cast<std::chrono::microseconds>(latency).count()));
  index_.write(row.data());
  next_index_ = scan.index + 1;
}

void ScanWriter::finish() { index_.commit(); }

std::size_t ScanWriter::stale_files() const {
  std::size_t count = 0;
  while (std::filesystem::exists(scan_path(next_index_ + count))) ++count;
  return count;
}

void ScanWriter::append_header(const LevelledScan& scan) {
  switch (format_) {
    case ScanFormat::pcd:
      append_text(buffer_, pcd_header(scan));
      break;
    case ScanFormat::ply:
      append_text(buffer_, ply_header(scan));
      break;
    case ScanFormat::csv:
      append_text(buffer_, "x,y,z,intensity,ring,time,label\n");
      break;
  }
}

void ScanWriter::append_binary_points(const LevelledScan& scan) {
  const std::size_t begin = buffer_.size();
  buffer_.resize(begin + scan.size() * kPointBytes);
  char* to = buffer_.data() + begin;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    to = put(to, scan.x[i]);
    to = put(to, scan.y[i]);
    to = put(to, scan.z[i]);
    to = put(to, scan.intensity[i]);
    to = put(to, static_cast<std::uint16_t>(scan.ring[i]));
    to = put(to, scan.time_ns[i]);
    to = put(to, static_cast<std::uint8_t>(scan.label[i]));
  }
}

void ScanWriter::append_text_points(const LevelledScan& scan) {
  for (std::size_t i = 0; i < scan.size(); ++i) {
    for (const float metres : {scan.x[i], scan.y[i], scan.z[i]}) {
      append_number(buffer_, metres);
      buffer_.push_back(',');
    }
    for (const std::uint32_t number :
         {std::uint32_t{scan.intensity[i]}, std::uint32_t{scan.ring[i]}, scan.time_ns[i]}) {
      append_number(buffer_, number);
      buffer_.push_back(',');
    }
    append_text(buffer_, scan.label[i] == Label::structure ? "1\n" : "0\n");
  }
}

}  // namespace convexcut::replay
