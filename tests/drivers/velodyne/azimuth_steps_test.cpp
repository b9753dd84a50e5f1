// SPDX-License-Identifier: Apache-2.0
//
// Does not prove: that real encoders fail in the ways that are imagined here.
#include "drivers/velodyne/azimuth_steps.hpp"

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace convexcut::velodyne {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

constexpr std::int32_t kMaxStep = 50;
using Azimuths = std::array<std::uint16_t, 12>;

TEST(AzimuthSteps, AreTheDifferencesAndTheLastBlockRepeatsItsPredecessor) {
  constexpr Azimuths azimuths{100, 115, 130, 146, 161, 176, 191, 206, 221, 236, 251, 265};
  EXPECT_THAT(azimuth_steps(azimuths, kMaxStep),
              ElementsAre(15, 15, 16, 15, 15, 15, 15, 15, 15, 15, 14, 14));
}

TEST(AzimuthSteps, CrossTheEndOfTheTurn) {
  constexpr Azimuths azimuths{35960, 35980, 0, 20, 40, 60, 80, 100, 120, 140, 160, 180};
  EXPECT_THAT(azimuth_steps(azimuths, kMaxStep), Each(20));
}

TEST(AzimuthSteps, ThirtySixThousandIsZero) {
  constexpr Azimuths azimuths{35960, 35980, 36000, 20, 40, 60, 80, 100, 120, 140, 160, 180};
  EXPECT_THAT(azimuth_steps(azimuths, kMaxStep), Each(20));
}

TEST(AzimuthSteps, TheMedianReplacesAGlitch) {
  constexpr Azimuths azimuths{100, 115, 130, 9000, 160, 175, 190, 205, 220, 235, 250, 265};
  EXPECT_THAT(azimuth_steps(azimuths, kMaxStep), Each(15));
}

TEST(AzimuthSteps, TheMedianReplacesAStepBackwards) {
  constexpr Azimuths azimuths{100, 115, 130, 90, 105, 120, 135, 150, 165, 180, 195, 210};
  EXPECT_THAT(azimuth_steps(azimuths, kMaxStep), Each(15));
}

TEST(AzimuthSteps, AGlitchInTheLastBlockIsNotRepeated) {
  constexpr Azimuths azimuths{100, 115, 130, 145, 160, 175, 190, 205, 220, 235, 250, 30000};
  EXPECT_THAT(azimuth_steps(azimuths, kMaxStep), Each(15));
}

TEST(AzimuthSteps, AStoppedRotorThatTremblesStaysWithinItsTremble) {
  constexpr Azimuths azimuths{0, 35999, 0, 35999, 0, 0, 35999, 0, 0, 0, 1, 0};
  for (const std::int32_t step : azimuth_steps(azimuths, kMaxStep)) {
    EXPECT_GE(step, -1);
    EXPECT_LE(step, 1);
  }
}

TEST(AzimuthSteps, AzimuthsThatAreNoRotationAreNotInterpolated) {
  constexpr Azimuths azimuths{0,    7000,  14000, 21000, 28000, 35000,
                              6000, 13000, 20000, 27000, 34000, 5000};
  EXPECT_THAT(azimuth_steps(azimuths, kMaxStep), Each(0));
}

TEST(AzimuthSteps, SixBlockPairsFillSixSteps) {
  constexpr std::array<std::uint16_t, 6> azimuths{35980, 36000, 20, 40, 61, 80};
  EXPECT_THAT(azimuth_steps(azimuths, kMaxStep),
              ElementsAre(20, 20, 20, 21, 19, 19, 0, 0, 0, 0, 0, 0));
}

}  // namespace
}  // namespace convexcut::velodyne
