// SPDX-License-Identifier: Apache-2.0
//
// The summary of a stream. Does not prove the rates of a real device: recordings_test.cpp does.
#include "drivers/xsens/mt_statistics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/drivers/xsens/frames.hpp"

namespace convexcut::xsens {
namespace {

using test::hex;
using test::make_data_message;

TEST(MtStatistics, CountsMessagesAndItems) {
  MtStatistics statistics;
  for (const std::string_view frame : test::kAllFrames) statistics.on_bytes(hex(frame));
  EXPECT_EQ(statistics.messages().at(0x36), 8U);
  EXPECT_EQ(statistics.messages().at(0x42), 1U);
  EXPECT_EQ(statistics.messages().at(0x18), 5U);
  EXPECT_EQ(statistics.items().at(0x1020).count, 8U);
  EXPECT_EQ(statistics.items().at(0x2010).count, 2U);
  EXPECT_EQ(statistics.items().at(0x2032).count, 1U);
  EXPECT_EQ(statistics.items().at(0x2032).smallest, 18);
  EXPECT_EQ(statistics.items().at(0x2032).largest, 18);
}

TEST(MtStatistics, RateComesFromTheDevicesTimeWhateverTheOrder) {
  MtStatistics statistics;
  for (const std::string_view time : {"000003E8", "00000258", "0000044C", "000004B0"}) {
    statistics.on_bytes(make_data_message("1060 04 " + std::string(time)));
  }
  EXPECT_NEAR(statistics.items().at(0x1060).rate_hz().value(), 50.0, 1e-9);  // 3 steps in 60 ms
}

TEST(MtStatistics, RateOfALoneItemIsUnknown) {
  MtStatistics statistics;
  statistics.on_bytes(make_data_message("1060 04 000003E8"));
  EXPECT_FALSE(statistics.items().at(0x1060).rate_hz());
  statistics.on_bytes(make_data_message("E010 01 05"));
  statistics.on_bytes(make_data_message("E010 01 05"));
  EXPECT_FALSE(statistics.items().at(0xE010).rate_hz()) << "no device time";
}

TEST(MtStatistics, DeviceIdAndProductCodeAreReported) {
  MtStatistics statistics;
  statistics.on_bytes(test::make_frame(0x01, hex("03 80 1A 2B")));
  statistics.on_bytes(test::make_frame(0x01, hex("03 80 1A 2B")));
  statistics.on_bytes(test::make_frame(0x1D, hex("4D 54 69 2D 33 30 20 20 00")));
  EXPECT_THAT(statistics.device_ids(), testing::ElementsAre("03801A2B"));
  EXPECT_THAT(statistics.product_codes(), testing::ElementsAre("MTi-30"));
}

TEST(MtStatistics, DamageIsReported) {
  MtStatistics statistics;
  test::ByteVector bad = hex(test::kQuaternionMessage);
  bad.back() ^= std::byte{1};
  statistics.on_bytes(bad);
  statistics.on_bytes(make_data_message("1020 02 00"));
  EXPECT_EQ(statistics.xbus().checksum_errors.value(), 1U);
  EXPECT_EQ(statistics.malformed_payloads(), 1U);
  EXPECT_TRUE(statistics.items().empty());
}

}  // namespace
}  // namespace convexcut::xsens
