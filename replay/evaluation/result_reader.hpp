// SPDX-License-Identifier: Apache-2.0
//
// Reads what `convexcut process --format pcd` wrote: scans.csv and scan_000000.pcd ….
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/time.hpp"
#include "replay/pcd_reader.hpp"

namespace convexcut::evaluation {

// A row of scans.csv.
struct ResultScan {
  std::uint64_t index = 0;
  HostTime stamp{};
  std::size_t points = 0;
  double coverage = 0.0;  // share of the revolution's firings, 0 … 1
};

class ResultReader {
 public:
  // Throws std::runtime_error of one line: no such folder or file, a row that is none (with its
  // line), no scan at all, scans of another format.
  explicit ResultReader(std::filesystem::path folder);

  [[nodiscard]] const std::vector<ResultScan>& scans() const noexcept { return scans_; }

  // Throws std::runtime_error of one line: cannot be read, no labels, no ring or time, another
  // number of points than scans.csv says.
  [[nodiscard]] replay::PcdCloud read(const ResultScan& scan) const;

 private:
  [[nodiscard]] std::filesystem::path path_of(const ResultScan& scan, const char* extension) const;

  std::filesystem::path folder_;
  std::vector<ResultScan> scans_;
};

}  // namespace convexcut::evaluation
