// SPDX-License-Identifier: Apache-2.0
//
// Which frames the kernel's filter rule (can.rst: (id & mask) == (filter id & mask)) lets through.
// Does not prove that a kernel follows it: socketcan_source_test.cpp does.
#include <algorithm>
#include <array>

#include <linux/can.h>
#include <linux/can/raw.h>

#include <gtest/gtest.h>

#include "drivers/can/can_imu_driver.hpp"
#include "drivers/socketcan/can_socket.hpp"

namespace convexcut::socketcan {
namespace {

bool passes(const std::vector<can_filter>& filters, canid_t id) {
  return std::any_of(filters.begin(), filters.end(), [id](const can_filter& filter) {
    return (id & filter.can_mask) == (filter.can_id & filter.can_mask);
  });
}

TEST(ExactFilters, LetEachIdentifierThroughAndNoOther) {
  const std::array ids{can::CanId{0x021}, can::CanId{0x034}};
  const auto filters = exact_filters(ids);
  ASSERT_EQ(filters.size(), 2U);
  for (canid_t id = 0; id <= CAN_SFF_MASK; ++id) {
    EXPECT_EQ(passes(filters, id), id == 0x021 || id == 0x034) << id;
  }
}

TEST(ExactFilters, TellTheTwoKindsOfIdentifiersApart) {
  const auto standard = exact_filters(std::array{can::CanId{0x021}});
  EXPECT_TRUE(passes(standard, 0x021));
  EXPECT_FALSE(passes(standard, 0x021 | CAN_EFF_FLAG));
  const auto extended = exact_filters(std::array{can::CanId{0x19FF0032, true}});
  EXPECT_TRUE(passes(extended, 0x19FF0032 | CAN_EFF_FLAG));
  EXPECT_FALSE(passes(extended, 0x19FF0033 | CAN_EFF_FLAG));
  EXPECT_FALSE(passes(extended, 0x032));
}

TEST(ExactFilters, KeepRequestsOut) {
  EXPECT_FALSE(passes(exact_filters(std::array{can::CanId{0x021}}), 0x021 | CAN_RTR_FLAG));
}

TEST(ExactFilters, ImuIsReceivedWithAllItsSamplesAreMadeOfAndItsReports) {
  can::XsensCanIds ids;
  ids[can::XsensMessage::quaternion] = 0x19FF0032;
  ids.extended = true;
  const auto received = can::received_ids(ids);
  // SampleTime, GroupCounter, StatusWord, Quaternion, EulerAngles, RateOfTurn, Acceleration; Error
  // and Warning.
  EXPECT_EQ(received.size(), 9U);
  EXPECT_NE(std::find(received.begin(), received.end(), can::CanId{0x19FF0032, true}),
            received.end());
  EXPECT_EQ(std::find(received.begin(), received.end(), can::CanId{0x061, true}), received.end());
  EXPECT_LE(received.size(), static_cast<std::size_t>(CAN_RAW_FILTER_MAX));
}

}  // namespace
}  // namespace convexcut::socketcan
