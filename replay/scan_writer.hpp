// SPDX-License-Identifier: Apache-2.0
//
// Labelled scans as files that other programs open: PCD v0.7 (binary), PLY (binary little-endian),
// CSV. PCD's VIEWPOINT is the lidar's position where poses are known. Fields `x y z intensity ring
// time label`: float32 metres in level; uint8; uint16 (0 = lowest beam); uint32 ns after the scan's
// stamp; uint8 (0 = other, 1 = structure). Points in firing order.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/scan/scan.hpp"
#include "core/workspace.hpp"
#include "replay/atomic_file.hpp"

namespace convexcut::replay {

enum class ScanFormat : std::uint8_t { pcd, ply, csv };

[[nodiscard]] std::string_view extension(ScanFormat format) noexcept;

// Writes scan_000000.EXT, scan_000001.EXT … and scans.csv into a directory, which is made if need
// be. scans.csv gets its name only in finish(). Throws std::runtime_error of one line.
class ScanWriter {
 public:
  ScanWriter(std::filesystem::path directory, ScanFormat format);

  // `latency` goes into scans.csv: how long after its last firing the scan was ready.
  void write(const LevelledScan& scan, Duration latency);
  void finish();

  // Scan files of an earlier run that this one did not replace, by number beyond its last.
  [[nodiscard]] std::size_t stale_files() const;

 private:
  [[nodiscard]] std::filesystem::path scan_path(std::uint64_t index) const;
  void append_header(const LevelledScan& scan);
  void append_binary_points(const LevelledScan& scan);
  void append_text_points(const LevelledScan& scan);

  std::filesystem::path directory_;
  ScanFormat format_;
  std::uint64_t next_index_ = 0;
  Workspace<char> buffer_;  // of the scan at hand
  AtomicFile index_;
};

}  // namespace convexcut::replay
