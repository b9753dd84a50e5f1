// SPDX-License-Identifier: Apache-2.0
#include "bench/convex_cut/measure.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>

namespace convexcut::bench {
namespace {

[[nodiscard]] double run_ms(const Contender& contender) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  contender.run();
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

[[nodiscard]] Timing timing_of(const std::string& name, std::vector<double> times_ms) {
  std::ranges::sort(times_ms);
  const std::size_t last = times_ms.size() - 1;
  return {name, times_ms[last / 2], times_ms[last * 99 / 100], times_ms[last]};
}

}  // namespace

std::vector<Timing> measure(const std::vector<Contender>& contenders, unsigned rounds) {
  std::vector<std::vector<double>> times_ms(contenders.size());
  const auto finish = [](const Contender& contender) {
    if (contender.after) contender.after();
  };
  for (const Contender& contender : contenders) {
    contender.run();
    finish(contender);
  }
  for (unsigned round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      for (unsigned run = 0; run < contenders[i].runs_a_round; ++run) {
        times_ms[i].push_back(run_ms(contenders[i]));
        finish(contenders[i]);
      }
    }
  }
  std::vector<Timing> timings;
  for (std::size_t i = 0; i < contenders.size(); ++i) {
    timings.push_back(timing_of(contenders[i].name, times_ms[i]));
  }
  return timings;
}

}  // namespace convexcut::bench
