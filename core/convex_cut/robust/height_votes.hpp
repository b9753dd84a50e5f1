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
    float height_m = 0.0F;   // the middle of its bin
  };
  static constexpr float kBinM = 0.004F;
  static constexpr float kWithinM = 1.5F * kBinM;  // of the mode's height: the three bins

  void add(float height_m) noexcept {
    // Rounded without a call: walls are laid on their faces by hundreds of these for each cell.
    const float at = height_m * kBinsPerM + kMiddleOfBins;
    if (at >= 1.0F && at < static_cast<float>(kBins - 1)) ++cells_[static_cast<std::size_t>(at)];
  }
  [[nodiscard]] Mode mode() const noexcept {
    Mode mode;
    for (std::size_t bin = 1; bin + 1 < kBins; ++bin) {
      const std::int32_t votes = cells_[bin - 1] + 2 * cells_[bin] + cells_[bin + 1];
      if (votes <= mode.votes) continue;
      mode = {votes, (static_cast<float>(bin) - static_cast<float>(kMiddleBin)) * kBinM};
    }
    return mode;
  }

 private:
  static constexpr std::size_t kBins = 41;
  static constexpr std::size_t kMiddleBin = kBins / 2;
  static constexpr float kBinsPerM = 1.0F / kBinM;
  static constexpr float kMiddleOfBins = static_cast<float>(kMiddleBin) + 0.5F;

  std::array<std::int32_t, kBins> cells_{};
};

}  // namespace convexcut::robust
