// SPDX-License-Identifier: Apache-2.0
//
// Lines and files of candump. Does not prove that a given candump version writes them so: they are
// made by hand from the format's description.
#include "drivers/can/candump.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/can/candump_reader.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::can {
namespace {

using convexcut::test::hex;
using convexcut::test::TemporaryDirectory;

CandumpStatus status_of(std::string_view line) {
  CandumpLine out;
  return parse_candump_line(line, out);
}

CandumpLine parse(std::string_view line) {
  CandumpLine out;
  EXPECT_EQ(parse_candump_line(line, out), CandumpStatus::frame) << line;
  return out;
}

// The frame part of a line.
CandumpStatus status_of_frame(std::string_view frame) {
  return status_of("(1700000000.000000) can0 " + std::string(frame));
}
CanFrame parse_frame(std::string_view frame) {
  return parse("(1700000000.000000) can0 " + std::string(frame)).frame;
}

TEST(CandumpLine, StandardFrame) {
  const CandumpLine line = parse("(1436509052.249713) can0 044#2A366C2BBA");
  EXPECT_EQ(to_ns(line.frame.stamp), 1'436'509'052'249'713'000);
  EXPECT_EQ(line.interface, "can0");
  EXPECT_EQ(line.direction, Direction::unknown);
  EXPECT_EQ(line.frame.id, 0x44U);
  EXPECT_FALSE(line.frame.extended || line.frame.remote || line.frame.error || line.frame.fd);
  EXPECT_THAT(line.frame.payload(), testing::ElementsAreArray(hex("2A366C2BBA")));
}

TEST(CandumpLine, EightDigitsAreAnExtendedId) {
  const CanFrame frame = parse("(1700000000.000100) can0 18FF0034#0000000009CF").frame;
  EXPECT_TRUE(frame.extended);
  EXPECT_EQ(frame.id, 0x18FF0034U);
  EXPECT_EQ(frame.length, 6);
  EXPECT_TRUE(parse_frame("00000034#").extended) << "by the digits, not by the number";
}

TEST(CandumpLine, FdFrame) {
  const CanFrame frame = parse("(1700000000.000200) can0 123##1112233").frame;
  EXPECT_TRUE(frame.fd);
  EXPECT_THAT(frame.payload(), testing::ElementsAreArray(hex("112233")));
  EXPECT_EQ(parse_frame("123##1" + std::string(128, 'A')).length, 64);
}

TEST(CandumpLine, ErrorFrameByItsFlag) {
  const CanFrame frame = parse("(1700000000.000300) can0 20000040#0000000000000000").frame;
  EXPECT_TRUE(frame.error);
  EXPECT_FALSE(frame.extended);
  EXPECT_EQ(frame.id, 0x40U);
  EXPECT_EQ(frame.length, 8);
}

TEST(CandumpLine, RemoteFrames) {
  for (const std::string_view text : {"123#R", "123#R0", "123#R4", "123#R8", "123#R8_F"}) {
    const CanFrame frame = parse_frame(text);
    EXPECT_TRUE(frame.remote) << text;
    EXPECT_EQ(frame.length, 0) << text;
  }
  for (const std::string_view text : {"123#R9", "123#RR", "123#R44", "123#R4_F", "20000001#R"}) {
    EXPECT_EQ(status_of_frame(text), CandumpStatus::bad_data) << text;
  }
}

TEST(CandumpLine, DotsMaySeparateBytes) {
  EXPECT_THAT(parse_frame("123#11.22.33").payload(), testing::ElementsAreArray(hex("112233")));
  EXPECT_THAT(parse_frame("123#11.2233").payload(), testing::ElementsAreArray(hex("112233")));
  EXPECT_EQ(status_of_frame("123#11..22"), CandumpStatus::bad_data);
  EXPECT_EQ(status_of_frame("123#.11"), CandumpStatus::bad_data);
  EXPECT_EQ(status_of_frame("123#11."), CandumpStatus::bad_data);
  EXPECT_EQ(status_of_frame("123#1.1"), CandumpStatus::bad_data);
}

TEST(CandumpLine, RawDlcAddsNoData) {
  EXPECT_EQ(parse_frame("123#1122334455667788_F").length, 8);
  EXPECT_EQ(parse_frame("123#1122334455667788_9").length, 8);
  EXPECT_EQ(status_of_frame("123#1122334455667788_8"), CandumpStatus::bad_data);
  EXPECT_EQ(status_of_frame("123#1122334455667788_"), CandumpStatus::bad_data);
  EXPECT_EQ(status_of_frame("123#1122334455667788_FF"), CandumpStatus::bad_data);
  EXPECT_EQ(status_of_frame("123#11_F"), CandumpStatus::bad_data);
  EXPECT_EQ(status_of_frame("123##0112233_F"), CandumpStatus::bad_data);
}

TEST(CandumpLine, EveryNumberOfDigitsOfDataIsAFrameOrBadData) {
  for (std::size_t digits = 0; digits <= 140; ++digits) {
    const std::string data(digits, '5');
    const bool whole = digits % 2 == 0;
    EXPECT_EQ(status_of_frame("123#" + data) == CandumpStatus::frame,
              whole && is_valid_length(digits / 2, false))
        << digits;
    EXPECT_EQ(status_of_frame("123##0" + data) == CandumpStatus::frame,
              whole && is_valid_length(digits / 2, true))
        << digits;
  }
}

TEST(CandumpLine, EmptyDataAndLowerCaseAreFine) {
  EXPECT_EQ(parse_frame("123#").length, 0);
  EXPECT_EQ(parse_frame("1ab#ff").id, 0x1ABU);
}

TEST(CandumpLine, DirectionToken) {
  EXPECT_EQ(parse("(1.000000) can0 123#11 R").direction, Direction::received);
  EXPECT_EQ(parse("(1.000000) can0 123#11 T").direction, Direction::transmitted);
  EXPECT_EQ(status_of("(1.000000) can0 123#11 X"), CandumpStatus::bad_ending);
  EXPECT_EQ(status_of("(1.000000) can0 123#11 R T"), CandumpStatus::bad_ending);
}

TEST(CandumpLine, FractionsOfAnyLength) {
  EXPECT_EQ(to_ns(parse("(1700000000.000100) can0 123#").frame.stamp), 1'700'000'000'000'100'000);
  EXPECT_EQ(to_ns(parse("(1700000000.000100001) can0 123#").frame.stamp),
            1'700'000'000'000'100'001);
  EXPECT_EQ(to_ns(parse("(0000000012.345) can0 123#").frame.stamp), 12'345'000'000);
}

TEST(CandumpLine, PaddedInterfaceAndLineEnds) {
  EXPECT_EQ(parse("(1.000000)  vcan0  123#11\r\n").interface, "vcan0");
  EXPECT_EQ(parse("(1.000000) can10    123#11").interface, "can10");
  EXPECT_EQ(parse(" (1.000000)\tcan0\t123#11 \n").interface, "can0");
}

TEST(CandumpLine, LinesThatAreNoFramesAreToldApart) {
  EXPECT_EQ(status_of(""), CandumpStatus::blank);
  EXPECT_EQ(status_of("  \r\n"), CandumpStatus::blank);
  EXPECT_EQ(status_of("DROPCOUNT: dropped 3 CAN frames on 'can0' socket (total drops 3)"),
            CandumpStatus::drop_note);
  EXPECT_EQ(status_of_frame("01123#00:05:12345678#112233"), CandumpStatus::can_xl);
  EXPECT_EQ(status_of_frame("123#00:05:12345678#112233"), CandumpStatus::can_xl);
}

TEST(CandumpLine, BadTimes) {
  for (const std::string_view time :
       {"1700000000.000000", "(1700000000)", "(.000000)", "(1.)", "(-1.000000)", "(1.0000000000)",
        "(99999999999.000000)", "(9223372036.000000)", "(1.00000a)", "(", "()", "(1.000000"}) {
    EXPECT_EQ(status_of(std::string(time) + " can0 123#11"), CandumpStatus::bad_time) << time;
  }
}

TEST(CandumpLine, LatestTimeDoesNotOverflow) {
  EXPECT_EQ(to_ns(parse("(9223372035.999999999) can0 123#").frame.stamp),
            9'223'372'035'999'999'999);
}

TEST(CandumpLine, BadIds) {
  for (const std::string_view frame :
       {"12#11", "1234#11", "800#11", "FFF#11", "1FFFFFFFF#11", "40000001#11", "80000001#11",
        "12G#11", "#11", "123", "12 3#11"}) {
    EXPECT_EQ(status_of_frame(frame), CandumpStatus::bad_id) << frame;
  }
}

TEST(CandumpLine, MissingParts) {
  EXPECT_EQ(status_of("(1.000000)"), CandumpStatus::bad_name);
  EXPECT_EQ(status_of("(1.000000) an_interface_of_22_chars 123#"), CandumpStatus::bad_name);
  EXPECT_EQ(status_of("(1.000000) can0"), CandumpStatus::bad_id);
  EXPECT_EQ(status_of_frame("123##"), CandumpStatus::bad_data);
  EXPECT_EQ(status_of_frame("123##G"), CandumpStatus::bad_data);
  EXPECT_EQ(status_of_frame("123#GG"), CandumpStatus::bad_data);
}

TEST(CandumpLine, NoTruncationReadsOutsideOrGivesMoreData) {
  const std::string_view line = "(1700000000.000100) can0 18FF0034#0000000009CF_ R";
  for (std::size_t size = 0; size <= line.size(); ++size) {
    const std::string exact(line.substr(0, size));  // so that the sanitizer sees the end
    CandumpLine out;
    if (parse_candump_line(exact, out) == CandumpStatus::frame) {
      EXPECT_LE(out.frame.length, 6);
    }
  }
}

class CandumpReaderTest : public testing::Test {
 protected:
  std::filesystem::path write(std::string_view text) {
    const std::filesystem::path file = directory_.path() / "candump.log";
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  static std::vector<std::uint32_t> ids(CandumpReader& reader) {
    std::vector<std::uint32_t> ids;
    CanFrame frame;
    while (reader.next(frame) == CandumpReader::Status::frame) ids.push_back(frame.id);
    return ids;
  }
  TemporaryDirectory directory_;
};

TEST_F(CandumpReaderTest, GivesTheFramesAndCountsTheRest) {
  CandumpReader reader(
      write("(1.000000) can0 001#11\n"
            "\n"
            "DROPCOUNT: dropped 3 CAN frames on 'can0' socket (total drops 3)\n"
            "(1.000001) can0 01123#00:05:12345678#112233\n"
            "garbage\n"
            "(1.000002) can0 002#22\r\n"
            "(1.000003) can0 003#33"));
  EXPECT_THAT(ids(reader), testing::ElementsAre(1, 2, 3));
  EXPECT_EQ(reader.counters().lines.value(), 7U);
  EXPECT_EQ(reader.counters().frames.value(), 3U);
  EXPECT_EQ(reader.counters().drop_notes.value(), 1U);
  EXPECT_EQ(reader.counters().can_xl.value(), 1U);
  EXPECT_EQ(reader.counters().malformed_lines.value(), 1U);
  EXPECT_EQ(reader.problem(), "");
  CanFrame frame;
  EXPECT_EQ(reader.next(frame), CandumpReader::Status::end) << "stays";
}

TEST_F(CandumpReaderTest, CanBeLimitedToOneInterface) {
  CandumpReader reader(write("(1.0) can0 001#\n(1.0) can1 002#\n(1.0) can0 003#\n"), "can0");
  EXPECT_THAT(ids(reader), testing::ElementsAre(1, 3));
  EXPECT_EQ(reader.counters().other_interfaces.value(), 1U);
}

TEST_F(CandumpReaderTest, LongLinesAreSkippedWholeAcrossBlocks) {
  const std::string start = "(1.000000) can0 001#11 ";
  CandumpReader reader(write(start + std::string(200'000, 'x') + "\n(1.0) can0 002#\n" +
                             "(1.0) can0 01123#00:05:12345678#" + std::string(4096, 'A') + "\n" +
                             std::string(513, ' ') + "\n(1.0) can0 003#\n"));
  EXPECT_THAT(ids(reader), testing::ElementsAre(2, 3));
  EXPECT_EQ(reader.counters().too_long_lines.value(), 2U);
  EXPECT_EQ(reader.counters().can_xl.value(), 1U);
  EXPECT_EQ(reader.counters().lines.value(), 5U);
}

TEST_F(CandumpReaderTest, LongLineThatEndsWithABlockIsTooLong) {
  std::string text = "(1.000000) can0 001#11";
  text.resize(65536, ' ');
  CandumpReader reader(write(text + "\n(1.0) can0 002#\n"));
  EXPECT_THAT(ids(reader), testing::ElementsAre(2));
  EXPECT_EQ(reader.counters().too_long_lines.value(), 1U);
}

TEST_F(CandumpReaderTest, ManyBlocksLoseNothingAtTheirBorders) {
  std::string text;
  for (unsigned i = 0; i < 20'000; ++i) {
    std::array<char, 64> line{};
    std::snprintf(line.data(), line.size(), "(%u.%06u) can0 %03X#%02X\n", i, i, i % 0x800, i % 256);
    text += line.data();
  }
  CandumpReader reader(write(text));
  CanFrame frame;
  for (unsigned i = 0; i < 20'000; ++i) {
    ASSERT_EQ(reader.next(frame), CandumpReader::Status::frame);
    ASSERT_EQ(frame.id, i % 0x800);
    ASSERT_EQ(to_ns(frame.stamp), i * 1'000'001'000LL);
  }
  EXPECT_EQ(reader.next(frame), CandumpReader::Status::end);
  EXPECT_EQ(reader.counters().malformed_lines.value(), 0U);
}

TEST_F(CandumpReaderTest, EmptyFileHasNoFrames) {
  CandumpReader reader(write(""));
  CanFrame frame;
  EXPECT_EQ(reader.next(frame), CandumpReader::Status::end);
}

TEST_F(CandumpReaderTest, MissingFileIsOneClearLine) {
  const std::string path = (directory_.path() / "absent.log").string();
  try {
    const CandumpReader reader(path);
    FAIL() << "opened a file that is not there";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), path + ": cannot open the candump log: No such file or directory");
  }
}

TEST_F(CandumpReaderTest, DirectoryIsOneClearLine) {
  try {
    const CandumpReader reader(directory_.path());
    FAIL() << "read a directory";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(),
              directory_.path().string() + ": cannot read the candump log: Is a directory");
  }
}

}  // namespace
}  // namespace convexcut::can
