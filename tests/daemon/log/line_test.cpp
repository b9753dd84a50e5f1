// SPDX-License-Identifier: Apache-2.0
//
// Does not prove that journald reads the priorities; that is systemd's documented format.
#include "daemon/log/line.hpp"

#include <cstdint>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace convexcut::daemon::log {
namespace {

using config::LogLevel;

std::string plain(std::initializer_list<Field> fields) {
  return format_line(Destination::plain, LogLevel::info, "event", fields);
}

TEST(LogLine, IsLevelEventAndKeyValuePairs) {
  EXPECT_EQ(format_line(Destination::plain, LogLevel::warning, "scan_late",
                        {{"scan", 17}, {"by_ms", 2.5}, {"published", true}, {"why", "hull"}}),
            "warning scan_late scan=17 by_ms=2.5 published=true why=hull\n");
}

TEST(LogLine, WithoutFieldsIsLevelAndEvent) { EXPECT_EQ(plain({}), "info event\n"); }

TEST(LogLine, ForTheJournalStartsWithTheSyslogPriorityInPlaceOfTheLevel) {
  EXPECT_EQ(format_line(Destination::journal, LogLevel::error, "e", {}), "<3>e\n");
  EXPECT_EQ(format_line(Destination::journal, LogLevel::warning, "e", {}), "<4>e\n");
  EXPECT_EQ(format_line(Destination::journal, LogLevel::info, "e", {}), "<6>e\n");
  EXPECT_EQ(format_line(Destination::journal, LogLevel::debug, "e", {}), "<7>e\n");
}

TEST(LogLine, QuotesValuesThatAreNotOneWord) {
  EXPECT_EQ(plain({{"path", "/my data/a.pcap"}}), "info event path=\"/my data/a.pcap\"\n");
  EXPECT_EQ(plain({{"empty", ""}}), "info event empty=\"\"\n");
  EXPECT_EQ(plain({{"pair", "a=b"}}), "info event pair=\"a=b\"\n");
}

TEST(LogLine, EscapesWhatWouldEndTheValueOrTheLine) {
  EXPECT_EQ(plain({{"v", "a\"b\\c\nd\te\x1b[0m\x7f"}}),
            "info event v=\"a\\\"b\\\\c\\nd\\te\\x1b[0m\\x7f\"\n");
}

TEST(LogLine, KeepsAZeroByteInsideAValue) {
  EXPECT_EQ(plain({{"v", std::string_view("a\0b", 3)}}), "info event v=\"a\\x00b\"\n");
}

TEST(LogLine, LeavesUtf8AsItIs) { EXPECT_EQ(plain({{"dir", "Räume"}}), "info event dir=Räume\n"); }

TEST(LogLine, EscapesAnEventThatHoldsALineBreak) {
  EXPECT_EQ(format_line(Destination::plain, LogLevel::info, "a\nerror b", {}),
            "info a\\nerror b\n");
}

TEST(LogLine, ShowsTheWholeRangeOfIntegers) {
  EXPECT_EQ(plain({{"min", std::numeric_limits<std::int64_t>::min()},
                   {"max", std::numeric_limits<std::uint64_t>::max()}}),
            "info event min=-9223372036854775808 max=18446744073709551615\n");
}

TEST(LogLine, CutsALongLineBetweenCharactersAndMarksIt) {
  std::string umlauts;
  for (int i = 0; i < 4000; ++i) umlauts += "ä";
  for (const char* prefix : {"", "x"}) {  // one of the two puts the cut inside a character
    const std::string line = plain({{"v", prefix + umlauts}});
    EXPECT_LE(line.size(), kMaxLineBytes);
    EXPECT_TRUE(line.ends_with("ä…\n")) << line.substr(line.size() - 8);
  }
}

}  // namespace
}  // namespace convexcut::daemon::log
