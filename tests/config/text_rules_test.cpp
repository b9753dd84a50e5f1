// SPDX-License-Identifier: Apache-2.0
//
// Names and paths. Does not prove that a path exists: that is found out where it is opened.
#include "config/text_rules.hpp"

#include <string>

#include <gtest/gtest.h>

namespace convexcut::config {
namespace {

TEST(TextRules, TopicNames) {
  for (const char* good : {"imu", "imu/data", "convexcut/structure", "_a/b_1/C"}) {
    EXPECT_TRUE(is_topic_name(good)) << good;
  }
  for (const char* bad : {"", "/imu", "imu/", "imu//data", "1imu", "imu/2", "imu data", "imu-data",
                          "~/imu", "a__b", "imu.data", "b\xC3\xBC"}) {
    EXPECT_FALSE(is_topic_name(bad)) << bad;
  }
  EXPECT_TRUE(is_topic_name(std::string(246, 'a')));
  EXPECT_FALSE(is_topic_name(std::string(247, 'a')));
}

TEST(TextRules, FrameNames) {
  for (const char* good : {"level", "robot/base-link", "imu.1"}) {
    EXPECT_TRUE(is_frame_name(good)) << good;
  }
  for (const char* bad : {"", "/level", "le vel", "le\nvel", "\xC3\xBC"}) {
    EXPECT_FALSE(is_frame_name(bad)) << bad;
  }
  EXPECT_FALSE(is_frame_name(std::string(256, 'a')));
}

TEST(TextRules, Paths) {
  for (const char* good : {"", "/etc/x.xml", "a b", "\xC3\xBC"}) {
    EXPECT_TRUE(is_path_or_empty(good)) << good;
  }
  for (const char* bad : {"a\nb", "\x7F"}) EXPECT_FALSE(is_path_or_empty(bad));
  EXPECT_FALSE(is_path_or_empty(std::string_view("a\0b", 3)));
  EXPECT_FALSE(is_path_or_empty(std::string(4096, 'a')));
}

TEST(TextRules, Addresses) {
  EXPECT_EQ(parse_ipv4("192.168.1.201"), 0xC0A801C9U);
  EXPECT_EQ(parse_ipv4("0.0.0.0"), 0U);
  EXPECT_EQ(parse_ipv4("255.255.255.255"), 0xFFFFFFFFU);
  for (const char* bad : {"1.2.3", "1.2.3.4.5", "1.2.3.256", "1.2.3.-4", "1.2.3.4 ", " 1.2.3.4",
                          "1..3.4", "01.2.3.4", "1.2.3.", ".1.2.3", "1.2.3.x", "::1"}) {
    EXPECT_EQ(parse_ipv4(bad), std::nullopt) << bad;
    EXPECT_FALSE(is_ipv4_or_empty(bad)) << bad;
  }
  EXPECT_EQ(parse_ipv4(""), std::nullopt);
  EXPECT_TRUE(is_ipv4_or_empty(""));
}

TEST(TextRules, MulticastGroups) {
  for (const char* good : {"", "224.0.0.0", "239.255.255.255"}) {
    EXPECT_TRUE(is_multicast_or_empty(good)) << good;
  }
  for (const char* bad : {"223.255.255.255", "240.0.0.0", "255.255.255.255", "239.1.1"}) {
    EXPECT_FALSE(is_multicast_or_empty(bad)) << bad;
  }
}

TEST(TextRules, Interfaces) {
  for (const char* good : {"", "eth0", "enp0s31f6.100", "fifteen-letters"}) {
    EXPECT_TRUE(is_interface_or_empty(good)) << good;
  }
  for (const char* bad : {".", "..", "a/b", "eth0:1", "a b", "sixteen-letters-", "a\nb"}) {
    EXPECT_FALSE(is_interface_or_empty(bad)) << bad;
  }
}

TEST(TextRules, Cpus) {
  EXPECT_EQ(parse_cpus("0"), CpuSet{0b1});
  EXPECT_EQ(parse_cpus("1,3-5"), CpuSet{0b111010});
  EXPECT_EQ(parse_cpus("2-2"), CpuSet{0b100});
  EXPECT_TRUE(parse_cpus("1023").value().test(1023));
  for (const char* bad :
       {",", "1,", ",1", "1-", "-1", "3-1", "1024", "a", "1 ,2", "1-2-3", "0x1"}) {
    EXPECT_EQ(parse_cpus(bad), std::nullopt) << bad;
    EXPECT_FALSE(is_cpus_or_empty(bad)) << bad;
  }
  EXPECT_EQ(parse_cpus(""), std::nullopt);
  EXPECT_TRUE(is_cpus_or_empty(""));
}

}  // namespace
}  // namespace convexcut::config
