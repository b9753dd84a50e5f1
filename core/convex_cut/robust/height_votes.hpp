// SPDX-License-Identifier: Apache-2.0
//
// The height over a plane that most of a wall's cells have, of those within 8 cm.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace convexcut::robust {

class HeightVotes {
 public:
  struct Mode {
    std::int32_t votes = 0;  // of its bin twice, of those beside it once
    float height_m = 0.0F;   // the mean of all three
  };

  void add(float height_m) noexcept {
    // Rounded without a call: walls are laid on their faces by hundreds of these for each cell.
    const float at = height_m * kBinsPerM + kMiddleOfBins;
    if (!(at >= 1.0F && at < static_cast<float>(kBins - 1))) return;
    const auto bin = static_cast<std::size_t>(at);
    ++cells_[bin];
    sums_m_[bin] += height_m;
  }
  [[nodiscard]] Mode mode() const noexcept {
    Mode mode;
    std::size_t best = 1;
    for (std::size_t bin = 1; bin + 1 < kBins; ++bin) {
      const std::int32_t votes = cells_[bin - 1] + 2 * cells_[bin] + cells_[bin + 1];
      if (votes <= mode.votes) continue;
      mode.votes = votes;
      best = bin;
    }
    if (mode.votes > 0) {
      mode.height_m = (sums_m_[best - 1] + sums_m_[best] + sums_m_[best + 1]) /
                      static_cast<float>(cells_[best - 1] + cells_[best] + cells_[best + 1]);
    }
    return mode;
  }

 private:
  static constexpr float kBinM = 0.004F;
  static constexpr std::size_t kBins = 41;
  static constexpr float kBinsPerM = 1.0F / kBinM;
  static constexpr float kMiddleOfBins = static_cast<float>(kBins) / 2.0F;  // kBins is odd

  std::array<std::int32_t, kBins> cells_{};
  std::array<float, kBins> sums_m_{};
};

}  // namespace convexcut::robust
