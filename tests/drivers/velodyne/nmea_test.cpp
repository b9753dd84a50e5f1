// SPDX-License-Identifier: Apache-2.0
//
// Does not prove: that every receiver's dialect is understood; only RMC and GGA are read.
#include "drivers/velodyne/nmea.hpp"

#include <chrono>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace convexcut::velodyne {
namespace {

using namespace std::chrono;
using namespace std::string_view_literals;

// "$" body "*" checksum CR LF.
std::string sentence(std::string_view body) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  std::string text = "$";
  text.append(body);
  text += '*';
  text += kDigits[sum / 16];
  text += kDigits[sum % 16];
  text += "\r\n";
  return text;
}

NmeaFix parsed(std::string_view text) {
  NmeaFix fix;
  EXPECT_EQ(parse_nmea(text, fix), NmeaStatus::ok) << text;
  return fix;
}

NmeaStatus status_of(std::string_view text) {
  NmeaFix fix;
  return parse_nmea(text, fix);
}

// As a VLP-16 passed it on in 2016.
constexpr std::string_view kRecorded =
    "$GPRMC,081802.00,A,3649.7478558,N,00224.4542928,W,0.034,212.5,210116,0.0,E,A*2E\r\n";

TEST(Nmea, RmcGivesDateTimeAndPlace) {
  const NmeaFix fix = parsed(kRecorded);
  EXPECT_TRUE(fix.valid);
  EXPECT_EQ(fix.time_of_day, hours{8} + minutes{18} + seconds{2});
  EXPECT_EQ(fix.date, year{2016} / January / 21);
  EXPECT_NEAR(fix.latitude->value, 36.0 + 49.7478558 / 60.0, 1e-12);
  EXPECT_NEAR(fix.longitude->value, -(2.0 + 24.4542928 / 60.0), 1e-12);
}

TEST(Nmea, TimeComesWithAndWithoutDecimals) {
  EXPECT_EQ(parsed(sentence("GPRMC,235959,A,,,,,,,,,")).time_of_day,
            hours{23} + minutes{59} + seconds{59});
  EXPECT_EQ(parsed(sentence("GPRMC,000000.5,A,,,,,,,,,")).time_of_day, milliseconds{500});
  EXPECT_EQ(parsed(sentence("GPRMC,000000.123456789012,A,,,,,,,,,")).time_of_day,
            nanoseconds{123'456'789});
  EXPECT_EQ(parsed(sentence("GPRMC,000001.,A,,,,,,,,,")).time_of_day, seconds{1});
}

TEST(Nmea, LeapSecondIsATime) {
  EXPECT_EQ(parsed(sentence("GPRMC,235960,A,,,,,,,,,")).time_of_day, hours{24});
}

TEST(Nmea, StatusVIsNotValid) {
  EXPECT_FALSE(parsed(sentence("GPRMC,081802,V,,,,,,,210116,,")).valid);
}

TEST(Nmea, EmptyFieldsOfAReceiverWithoutAFixAreAllowed) {
  const NmeaFix fix = parsed("$GPRMC,,V,,,,,,,,,,N*53\r\n");
  EXPECT_FALSE(fix.valid);
  EXPECT_FALSE(fix.time_of_day.has_value());
  EXPECT_FALSE(fix.date.has_value());
  EXPECT_FALSE(fix.latitude.has_value());
  EXPECT_FALSE(fix.longitude.has_value());
}

TEST(Nmea, AnyTalkerIsRead) {
  EXPECT_TRUE(parsed(sentence("GNRMC,081802,A,,,,,,,210116,,")).valid);
  EXPECT_TRUE(parsed(sentence("GLRMC,081802,A,,,,,,,210116,,")).valid);
}

TEST(Nmea, GgaGivesTimeAndPlaceWithoutDate) {
  const NmeaFix fix =
      parsed("$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n");
  EXPECT_TRUE(fix.valid);
  EXPECT_EQ(fix.time_of_day, hours{12} + minutes{35} + seconds{19});
  EXPECT_FALSE(fix.date.has_value());
  EXPECT_NEAR(fix.latitude->value, 48.1173, 1e-9);
  EXPECT_NEAR(fix.longitude->value, 11.516666667, 1e-9);
}

TEST(Nmea, GgaOfQualityZeroIsNotValid) {
  EXPECT_FALSE(parsed(sentence("GPGGA,123519,,,,,0,00,,,M,,M,,")).valid);
}

TEST(Nmea, SouthAndWestAreNegative) {
  const NmeaFix fix = parsed(sentence("GPRMC,000000,A,3351.00,S,07040.00,W,,,,,"));
  EXPECT_NEAR(fix.latitude->value, -33.85, 1e-12);
  EXPECT_NEAR(fix.longitude->value, -70.66666666666667, 1e-12);
}

TEST(Nmea, YearsFromEightyOnAreOfTheLastCentury) {
  EXPECT_EQ(parsed(sentence("GPRMC,,A,,,,,,,060180,,")).date, year{1980} / January / 6);
  EXPECT_EQ(parsed(sentence("GPRMC,,A,,,,,,,311279,,")).date, year{2079} / December / 31);
}

TEST(Nmea, OtherSentencesAreUnsupported) {
  EXPECT_EQ(status_of(sentence("GPGSV,3,1,11")), NmeaStatus::unsupported);
  EXPECT_EQ(status_of(sentence("PGRMF,1")), NmeaStatus::unsupported);
  EXPECT_EQ(status_of(sentence("")), NmeaStatus::unsupported);
}

TEST(Nmea, EmptyFieldIsAbsent) {
  EXPECT_EQ(status_of(""), NmeaStatus::absent);
  EXPECT_EQ(status_of("\0\0\0$GPRMC"sv), NmeaStatus::absent);
  EXPECT_EQ(status_of("\r\n"), NmeaStatus::absent);
}

TEST(Nmea, NulEndsTheSentenceAndWhatFollowsIsIgnored) {
  std::string text(kRecorded.substr(0, kRecorded.size() - 2));
  text += "\0\0garbage $ * , \xFF\xFE"sv;
  EXPECT_EQ(status_of(text), NmeaStatus::ok);
}

TEST(Nmea, SentenceMayEndWithTheField) {
  EXPECT_EQ(status_of(kRecorded.substr(0, kRecorded.size() - 2)), NmeaStatus::ok);
}

TEST(Nmea, ChecksumMayBeInLowerCase) {
  std::string text(kRecorded);
  text.replace(text.find("*2E"), 3, "*2e");
  EXPECT_EQ(status_of(text), NmeaStatus::ok);
}

TEST(Nmea, AnyOneChangedCharacterFailsTheChecksum) {
  const std::size_t star = kRecorded.find('*');
  for (std::size_t i = 1; i < star; ++i) {
    std::string text(kRecorded);
    text[i] = static_cast<char>(text[i] ^ 0x01);
    EXPECT_NE(status_of(text), NmeaStatus::ok) << i;
  }
}

TEST(Nmea, EveryTruncationIsRejected) {
  const std::size_t whole = kRecorded.size() - 2;
  for (std::size_t length = 1; length < whole; ++length) {
    EXPECT_EQ(status_of(kRecorded.substr(0, length)), NmeaStatus::bad_checksum) << length;
  }
}

TEST(Nmea, MissingOrWrongChecksumIsNamedSo) {
  EXPECT_EQ(status_of("$GPRMC,,V,,,,,,,,,,N\r\n"), NmeaStatus::bad_checksum);
  EXPECT_EQ(status_of("$GPRMC,,V,,,,,,,,,,N*54\r\n"), NmeaStatus::bad_checksum);
  EXPECT_EQ(status_of("$GPRMC,,V,,,,,,,,,,N*5\r\n"), NmeaStatus::bad_checksum);
  EXPECT_EQ(status_of("$GPRMC,,V,,,,,,,,,,N*5G\r\n"), NmeaStatus::bad_checksum);
  EXPECT_EQ(status_of("$GPRMC,,V,,,,,,,,,,N*530\r\n"), NmeaStatus::bad_checksum);
}

TEST(Nmea, TextThatIsNoSentenceIsMalformed) {
  EXPECT_EQ(status_of("GPRMC,,V*00"), NmeaStatus::malformed);
  EXPECT_EQ(status_of("\xFF\xFF"), NmeaStatus::malformed);
}

class MalformedNmea : public ::testing::TestWithParam<const char*> {};

TEST_P(MalformedNmea, IsRejectedAndLeavesTheFixAlone) {
  NmeaFix fix;
  fix.valid = true;
  fix.time_of_day = seconds{5};
  EXPECT_EQ(parse_nmea(sentence(GetParam()), fix), NmeaStatus::malformed);
  EXPECT_TRUE(fix.valid);
  EXPECT_EQ(fix.time_of_day, seconds{5});
  EXPECT_FALSE(fix.date.has_value());
}

INSTANTIATE_TEST_SUITE_P(
    Fields, MalformedNmea,
    ::testing::Values("GPRMC", "GPRMC,240000,A,,,,,,,,,", "GPRMC,126000,A,,,,,,,,,",
                      "GPRMC,120061,A,,,,,,,,,", "GPRMC,12000,A,,,,,,,,,",
                      "GPRMC,1200000,A,,,,,,,,,", "GPRMC,12:00:00,A,,,,,,,,,",
                      "GPRMC,120000.x,A,,,,,,,,,", "GPRMC,-20000,A,,,,,,,,,",
                      "GPRMC,120000,X,,,,,,,,,", "GPRMC,120000,,,,,,,,,,",
                      "GPRMC,120000,A,9001.0,N,,,,,,,", "GPRMC,120000,A,4560.0,N,,,,,,,",
                      "GPRMC,120000,A,4500.0,X,,,,,,,", "GPRMC,120000,A,4500.0,,,,,,,,",
                      "GPRMC,120000,A,,,18001.0,E,,,,,", "GPRMC,120000,A,nan,N,,,,,,,",
                      "GPRMC,120000,A,,,,,,,320116,,", "GPRMC,120000,A,,,,,,,290217,,",
                      "GPRMC,120000,A,,,,,,,001316,,", "GPRMC,120000,A,,,,,,,0101160,,",
                      "GPRMC,120000,A,,,,,,,010116.0,,", "GPGGA,120000,,,,,,08",
                      "GPGGA,120000,,,,,X,08"));

}  // namespace
}  // namespace convexcut::velodyne
