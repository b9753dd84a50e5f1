// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

namespace convexcut::bench {

// Prints as the console reporter does and keeps the median rate of every benchmark, so that two
// queues can be compared within one run.
class RatioReporter : public benchmark::ConsoleReporter {
 public:
  // Without colours: the output is read by scripts.
  RatioReporter() : ConsoleReporter(OO_Tabular) {}
  void ReportRuns(const std::vector<Run>& runs) override;

  // Median rate of `ours` over median rate of `peer`, by benchmark name; 0 when one did not run.
  [[nodiscard]] double ratio(const std::string& ours, const std::string& peer) const;

 private:
  std::map<std::string, double> median_rate_;  // transfers a second
};

struct NamedRatio {
  std::string name;
  double value = 0.0;
};

// Throws std::runtime_error naming the file.
void write_json(const std::filesystem::path& file, const std::vector<NamedRatio>& ratios);

}  // namespace convexcut::bench
