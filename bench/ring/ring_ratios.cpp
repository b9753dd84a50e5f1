// SPDX-License-Identifier: Apache-2.0
#include "bench/ring/ring_ratios.hpp"

#include <cstddef>
#include <fstream>
#include <stdexcept>

namespace convexcut::bench {

void RatioReporter::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    const auto rate = run.counters.find("items_per_second");
    if (run.aggregate_name == "median" && rate != run.counters.end()) {
      median_rate_[run.run_name.function_name] = rate->second;
    }
  }
  ConsoleReporter::ReportRuns(runs);
}

double RatioReporter::ratio(const std::string& ours, const std::string& peer) const {
  const auto our_rate = median_rate_.find(ours);
  const auto peer_rate = median_rate_.find(peer);
  if (our_rate == median_rate_.end() || peer_rate == median_rate_.end()) return 0.0;
  return our_rate->second / peer_rate->second;
}

void write_json(const std::filesystem::path& file, const std::vector<NamedRatio>& ratios) {
  std::ofstream out(file);
  out << "{";
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    out << (i == 0 ? "\n" : ",\n") << "  \"" << ratios[i].name << "\": " << ratios[i].value;
  }
  out << "\n}\n";
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace convexcut::bench
