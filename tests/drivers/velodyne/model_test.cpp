// SPDX-License-Identifier: Apache-2.0
//
// Spot checks of the tables against the manuals. Does not prove: every entry of the VLP-32C table,
// of which the checks below touch a few; rings and periods are checked at compile time.
#include "drivers/velodyne/model.hpp"

#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

namespace convexcut::velodyne {
namespace {

TEST(Hdl32e, ElevationsAreMultiplesOfFourThirdsOfADegree) {
  const Model& model = model_of(ModelId::hdl32e);
  for (std::size_t c = 0; c < model.lasers; ++c) {
    const double exact = (static_cast<double>(model.ring[c]) - 23.0) * 4000.0 / 3.0;
    EXPECT_NEAR(model.elevation_mdeg[c], exact, 5.0) << c;
  }
}

// 1.152·(c/2), as a well-known driver has it, is a VLP-32C's pairing.
TEST(Hdl32e, EveryLaserFiresOneIntervalAfterTheLast) {
  const Model& model = model_of(ModelId::hdl32e);
  EXPECT_EQ(model.laser_time_ns(0), 0U);
  EXPECT_EQ(model.laser_time_ns(1), 1'152U);
  EXPECT_EQ(model.laser_time_ns(31), 35'712U);
  EXPECT_EQ(model.firing_period_ns, 46'080U);
}

TEST(Hdl32e, DualReturnPacketsCoverHalfTheTime) {
  EXPECT_EQ(model_of(ModelId::hdl32e).packet_period_ns(false), 552'960U);
  EXPECT_EQ(model_of(ModelId::hdl32e).packet_period_ns(true), 276'480U);
}

TEST(Hdl32e, HasNoAzimuthOffsets) {
  for (const std::int32_t offset : model_of(ModelId::hdl32e).azimuth_offset_mdeg) {
    EXPECT_EQ(offset, 0);
  }
}

// Focal point 28.83 mm from the axis: the beam leaves at 28.83·tan(−ω).
TEST(Hdl32e, VerticalOffsetsFollowTheEnvelopeDrawing) {
  const Model& model = model_of(ModelId::hdl32e);
  for (std::size_t c = 0; c < model.lasers; ++c) {
    const double elevation = model.elevation_mdeg[c] * 1e-3 * M_PI / 180.0;
    EXPECT_NEAR(model.vertical_offset_um[c], 28'830.0 * std::tan(-elevation), 80.0) << c;
  }
}

TEST(Vlp16, ElevationsAreTheOddDegreesFromMinusFifteen) {
  const Model& model = model_of(ModelId::vlp16);
  ASSERT_EQ(model.lasers, 16);
  for (std::size_t c = 0; c < model.lasers; ++c) {
    EXPECT_EQ(model.elevation_mdeg[c], -15'000 + 2'000 * model.ring[c]) << c;
  }
}

TEST(Vlp16, VerticalOffsetsFollowTheFocalDistance) {
  const Model& model = model_of(ModelId::vlp16);
  for (std::size_t c = 0; c < model.lasers; ++c) {
    const double elevation = model.elevation_mdeg[c] * 1e-3 * M_PI / 180.0;
    EXPECT_NEAR(model.vertical_offset_um[c], 41'910.0 * std::tan(-elevation), 60.0) << c;
  }
}

TEST(PuckHires, ElevationsAreMultiplesOfFourThirdsFromMinusTen) {
  const Model& model = model_of(ModelId::puck_hires);
  for (std::size_t c = 0; c < model.lasers; ++c) {
    EXPECT_NEAR(model.elevation_mdeg[c], -10'000 + model.ring[c] * 4000.0 / 3.0, 0.7) << c;
  }
}

TEST(Vlp32c, LasersFireInPairs) {
  const Model& model = model_of(ModelId::vlp32c);
  EXPECT_EQ(model.laser_time_ns(0), 0U);
  EXPECT_EQ(model.laser_time_ns(1), 0U);
  EXPECT_EQ(model.laser_time_ns(2), 2'304U);
  EXPECT_EQ(model.laser_time_ns(31), 34'560U);
}

TEST(Vlp32c, DistanceUnitIsFourMillimetres) {
  EXPECT_EQ(model_of(ModelId::vlp32c).distance_unit_mm, 4);
  EXPECT_EQ(model_of(ModelId::hdl32e).distance_unit_mm, 2);
  EXPECT_EQ(model_of(ModelId::vlp16).distance_unit_mm, 2);
}

TEST(Vlp32c, OffsetsAreThoseToAddNotTheirNegatives) {
  const Model& model = model_of(ModelId::vlp32c);
  EXPECT_EQ(model.azimuth_offset_mdeg[0], 1'400);
  EXPECT_EQ(model.azimuth_offset_mdeg[1], -4'200);
  EXPECT_EQ(model.azimuth_offset_mdeg[28], 4'200);
  for (const std::int32_t offset : model.azimuth_offset_mdeg) {
    EXPECT_TRUE(std::abs(offset) == 1'400 || std::abs(offset) == 4'200) << offset;
  }
}

TEST(Vlp32c, ExtremeBeamsAreTheFirstAndTheTwentyNinth) {
  const Model& model = model_of(ModelId::vlp32c);
  EXPECT_EQ(model.elevation_mdeg[0], -25'000);
  EXPECT_EQ(model.ring[0], 0);
  EXPECT_EQ(model.elevation_mdeg[29], 15'000);
  EXPECT_EQ(model.ring[29], 31);
  EXPECT_EQ(model.elevation_mdeg[3], -15'639);
  EXPECT_EQ(model.ring[3], 1);
}

TEST(ModelOfProduct, KnowsTheBytesOfTheFourModelsOnly) {
  EXPECT_EQ(model_of_product(0x21), ModelId::hdl32e);
  EXPECT_EQ(model_of_product(0x22), ModelId::vlp16);
  EXPECT_EQ(model_of_product(0x24), ModelId::puck_hires);
  EXPECT_EQ(model_of_product(0x28), ModelId::vlp32c);
  EXPECT_EQ(model_of_product(0x23), std::nullopt);
  EXPECT_EQ(model_of_product(0x00), std::nullopt);
  EXPECT_EQ(model_of_product(0xA1), std::nullopt);
}

}  // namespace
}  // namespace convexcut::velodyne
