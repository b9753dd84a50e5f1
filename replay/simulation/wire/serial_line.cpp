// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/wire/serial_line.hpp"

#include <algorithm>

#include "drivers/xsens/xbus.hpp"

namespace convexcut::simulation {
namespace {

// The gap from one read to the next, as of a USB adapter and a loaded host.
constexpr double kShortestGapNs = 0.3e6;
constexpr double kLongestGapNs = 5e6;

}  // namespace

void SerialLine::send(HostTime begin, std::span<const std::byte> bytes) {
  if (!arrivals_.empty()) begin = std::max(begin, arrivals_.back());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes_.push_back(bytes[i]);
    arrivals_.push_back(begin + xsens::line_time(i + 1, baud_));
  }
}

std::vector<SerialRead> SerialLine::reads(Random& random) const {
  std::vector<SerialRead> reads;
  if (bytes_.empty()) return reads;
  HostTime now = arrivals_.front();
  std::size_t taken = 0;
  while (taken < bytes_.size()) {
    const auto until = std::upper_bound(arrivals_.begin(), arrivals_.end(), now);
    const auto arrived = static_cast<std::size_t>(until - arrivals_.begin());
    if (arrived > taken) {
      reads.push_back({now, std::span(bytes_).subspan(taken, arrived - taken)});
      taken = arrived;
    }
    now += Duration{static_cast<Duration::rep>(random.uniform(kShortestGapNs, kLongestGapNs))};
  }
  return reads;
}

}  // namespace convexcut::simulation
