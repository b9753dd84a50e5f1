// SPDX-License-Identifier: Apache-2.0
//
// Does not prove: detection of two sensors that share a network without a configured sender.
#include "drivers/velodyne/model_detector.hpp"

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <optional>

#include <gtest/gtest.h>

#include "tests/drivers/velodyne/packets.hpp"

namespace convexcut::velodyne {
namespace {

using test::DataPacket;
using test::kDual;
using test::kSingle;

// Packets of one sensor; `sequence` counts packets, lost ones included.
class Sensor {
 public:
  Sensor(double period_us, std::uint8_t mode, std::uint8_t product) : period_us_(period_us) {
    packet_.mode(mode).product(product);
  }
  Sensor& starts_at(double micros) {
    start_us_ = micros;
    return *this;
  }
  Sensor& equal_azimuth_pairs() {
    packet_.azimuths(100, 16, 2);
    return *this;
  }
  DataPacket& packet(int sequence) {
    const double micros = std::fmod(start_us_ + sequence * period_us_, 3.6e9);
    return packet_.timestamp(static_cast<std::uint32_t>(micros));
  }

 private:
  double period_us_;
  double start_us_ = 1000.7;
  DataPacket packet_;
};

// What the detector says of these packets, asked after every one as the driver does.
std::optional<ModelId> detect(Sensor sensor, std::initializer_list<int> sequence) {
  ModelDetector detector;
  for (const int number : sequence) {
    if (const auto model = detector.observe(sensor.packet(number).bytes())) return model;
  }
  return detector.conclude();
}

TEST(ModelDetector, TellsEveryModelInSingleReturnMode) {
  EXPECT_EQ(detect({552.96, kSingle, 0x21}, {0, 1, 2, 3}), ModelId::hdl32e);
  EXPECT_EQ(detect({1327.104, kSingle, 0x22}, {0, 1, 2, 3}), ModelId::vlp16);
  EXPECT_EQ(detect({1327.104, kSingle, 0x24}, {0, 1, 2, 3}), ModelId::puck_hires);
  EXPECT_EQ(detect({663.552, kSingle, 0x28}, {0, 1, 2, 3}), ModelId::vlp32c);
}

TEST(ModelDetector, TellsEveryModelInDualReturnMode) {
  EXPECT_EQ(detect({276.48, kDual, 0x21}, {0, 1, 2, 3}), ModelId::hdl32e);
  EXPECT_EQ(detect({663.552, kDual, 0x22}, {0, 1, 2, 3}), ModelId::vlp16);
  EXPECT_EQ(detect({663.552, kDual, 0x24}, {0, 1, 2, 3}), ModelId::puck_hires);
  EXPECT_EQ(detect({331.776, kDual, 0x28}, {0, 1, 2, 3}), ModelId::vlp32c);
}

TEST(ModelDetector, NeedsThreeSteps) {
  Sensor sensor(552.96, kSingle, 0x21);
  ModelDetector detector;
  EXPECT_EQ(detector.observe(sensor.packet(0).bytes()), std::nullopt);
  EXPECT_EQ(detector.observe(sensor.packet(1).bytes()), std::nullopt);
  EXPECT_EQ(detector.observe(sensor.packet(2).bytes()), std::nullopt);
  EXPECT_EQ(detector.observe(sensor.packet(3).bytes()), ModelId::hdl32e);
}

// A VLP-16 of 2014 says that it is an HDL-32E.
TEST(ModelDetector, StepsWinOverALyingProductByte) {
  EXPECT_EQ(detect({1327.104, kSingle, 0x21}, {0, 1, 2, 3}), ModelId::vlp16);
  EXPECT_EQ(detect({552.96, kSingle, 0x22}, {0, 1, 2, 3}), ModelId::hdl32e);
  EXPECT_EQ(detect({663.552, kSingle, 0x21}, {0, 1, 2, 3}), ModelId::vlp32c);
}

TEST(ModelDetector, UnsetProductByteIsNoObstacle) {
  EXPECT_EQ(detect({552.96, 0, 0}, {0, 1, 2, 3}), ModelId::hdl32e);
  EXPECT_EQ(detect({1327.104, 0, 0}, {0, 1, 2, 3}), ModelId::vlp16);
}

TEST(ModelDetector, SameStepIsAVlp32cOrADualVlp16ByTheAzimuthPairs) {
  EXPECT_EQ(detect({663.552, 0, 0}, {0, 1, 2, 3}), ModelId::vlp32c);
  EXPECT_EQ(detect(Sensor(663.552, 0, 0).equal_azimuth_pairs(), {0, 1, 2, 3}), ModelId::vlp16);
}

TEST(ModelDetector, LostPacketsDoNotFoolIt) {
  EXPECT_EQ(detect({552.96, kSingle, 0}, {0, 2, 3, 7}), ModelId::hdl32e);
  EXPECT_EQ(detect({552.96, kSingle, 0x28}, {0, 2, 4, 6}), ModelId::hdl32e);
  EXPECT_EQ(detect({1327.104, kSingle, 0x21}, {0, 2, 4, 6}), ModelId::vlp16);
  EXPECT_EQ(detect({663.552, kSingle, 0x21}, {0, 2, 3, 5}), ModelId::vlp32c);
  EXPECT_EQ(detect({276.48, kDual, 0}, {0, 2, 4, 6}), ModelId::hdl32e);
}

// Every other packet lost: the steps are a VLP-16's, and the byte decides.
TEST(ModelDetector, ProductByteDecidesBetweenModelsThatFit) {
  EXPECT_EQ(detect({663.552, kSingle, 0x28}, {0, 2, 4, 6}), ModelId::vlp32c);
}

TEST(ModelDetector, GapsOfManyPacketsArePassedOver) {
  // 3317.76 µs is 6 packets of an HDL-32E and 5 of a VLP-32C.
  EXPECT_EQ(detect({552.96, kSingle, 0}, {0, 6, 12, 18, 19, 20, 21}), ModelId::hdl32e);
  EXPECT_EQ(detect({552.96, kSingle, 0}, {0, 6, 12, 18, 24, 30, 36, 42}), std::nullopt);
}

TEST(ModelDetector, HourWrapIsAStepLikeAnyOther) {
  EXPECT_EQ(detect(Sensor(552.96, kSingle, 0).starts_at(3.6e9 - 700.0), {0, 1, 2, 3}),
            ModelId::hdl32e);
}

TEST(ModelDetector, AClockThatIsSetInBetweenIsPassedOver) {
  Sensor before(552.96, kSingle, 0);
  Sensor after = Sensor(552.96, kSingle, 0).starts_at(2.5e9);
  ModelDetector detector;
  EXPECT_EQ(detector.observe(before.packet(0).bytes()), std::nullopt);
  EXPECT_EQ(detector.observe(before.packet(1).bytes()), std::nullopt);
  EXPECT_EQ(detector.observe(after.packet(2).bytes()), std::nullopt);
  EXPECT_EQ(detector.observe(after.packet(3).bytes()), std::nullopt);
  EXPECT_EQ(detector.observe(after.packet(4).bytes()), ModelId::hdl32e);
}

// The 663 µs from the last dual packet to the first single one would be a VLP-32C's.
TEST(ModelDetector, AChangeOfReturnModeIsPassedOver) {
  DataPacket packet;
  ModelDetector detector;
  packet.mode(kDual);
  EXPECT_EQ(detector.observe(packet.timestamp(0).bytes()), std::nullopt);
  EXPECT_EQ(detector.observe(packet.timestamp(663).bytes()), std::nullopt);
  packet.mode(kSingle);
  EXPECT_EQ(detector.observe(packet.timestamp(1327).bytes()), std::nullopt);
  EXPECT_EQ(detector.observe(packet.timestamp(2654).bytes()), std::nullopt);
  EXPECT_EQ(detector.observe(packet.timestamp(3981).bytes()), ModelId::vlp16);
}

TEST(ModelDetector, WithoutUsableStepsTheProductByteDecides) {
  EXPECT_EQ(detect({40.0, kSingle, 0x22}, {0, 1, 2, 3, 4, 5, 6, 7}), ModelId::vlp16);
  EXPECT_EQ(detect({552.96, kSingle, 0x24}, {0}), ModelId::puck_hires);
}

TEST(ModelDetector, WithoutUsableStepsAndProductByteItSaysNothing) {
  EXPECT_EQ(detect({40.0, kSingle, 0x77}, {0, 1, 2, 3, 4, 5, 6, 7}), std::nullopt);
  EXPECT_EQ(ModelDetector{}.conclude(), std::nullopt);
}

TEST(ModelDetector, StepsThatContradictEachOtherAreNoEvidence) {
  DataPacket packet;
  packet.product(0x22);
  ModelDetector detector;
  for (const std::uint32_t micros : {0U, 553U, 1880U, 2433U, 3760U}) {  // 553 and 1327 in turn
    EXPECT_EQ(detector.observe(packet.timestamp(micros).bytes()), std::nullopt);
  }
  EXPECT_EQ(detector.conclude(), ModelId::vlp16);
}

}  // namespace
}  // namespace convexcut::velodyne
