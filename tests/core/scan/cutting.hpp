// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scan/scan_cutter.hpp"
#include "tests/core/scan/synthetic_lidar.hpp"

namespace convexcut::test {

// A cutter with a collector of copies of its scans.
class Cutting {
 public:
  explicit Cutting(const CutOptions& options = {}, std::size_t max_returns = 200'000,
                   std::size_t max_firings = 10'000)
      : cutter(options, max_returns, max_firings) {}
  void push(const TimedBatch& timed) { cutter.push(timed.batch, timed.first_firing, collect_); }
  void push(const SyntheticLidar& lidar, std::int64_t first_packet, std::int64_t end_packet) {
    for (std::int64_t n = first_packet; n < end_packet; ++n) push(lidar.packet(n));
  }
  void finish() { cutter.finish(collect_); }
  [[nodiscard]] std::vector<std::size_t> firings() const {
    std::vector<std::size_t> counts;
    for (const Scan& scan : scans) counts.push_back(scan.firings.size());
    return counts;
  }

  ScanCutter cutter;
  std::vector<Scan> scans;

 private:
  struct Collect {
    Cutting* to;
    void operator()(const Scan& scan) const { to->scans.push_back(scan); }
  };
  Collect collect_{this};
};

}  // namespace convexcut::test
