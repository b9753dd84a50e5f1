// SPDX-License-Identifier: Apache-2.0
//
// PCD files made here byte by byte. That the files of other programs are like these is proved only
// by the one recording of the last test.
#include "replay/pcd_reader.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/recordings.hpp"

namespace convexcut::replay {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

class PcdReader : public testing::Test {
 protected:
  PcdCloud read(const std::string& content) {
    std::ofstream(file_, std::ios::binary) << content;
    return read_pcd(file_);
  }
  std::string error(const std::string& content) {
    try {
      read(content);
    } catch (const std::runtime_error& e) {
      EXPECT_THAT(e.what(), HasSubstr(file_.string() + ": "));
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
      return e.what();
    }
    return "no error";
  }

  test::TemporaryDirectory folder_;
  std::filesystem::path file_ = folder_.path() / "cloud.pcd";
};

constexpr const char* kOurHeader =
    "# .PCD v0.7 - Point Cloud Data file format\n"
    "VERSION 0.7\n"
    "FIELDS x y z intensity ring time label\n"
    "SIZE 4 4 4 1 2 4 1\n"
    "TYPE F F F U U U U\n"
    "COUNT 1 1 1 1 1 1 1\n"
    "WIDTH 2\n"
    "HEIGHT 1\n"
    "VIEWPOINT 0 0 0 1 0 0 0\n"
    "POINTS 2\n"
    "DATA binary\n";

void append_point(std::string& bytes, float x, float y, float z, std::uint8_t label) {
  append(bytes, x);
  append(bytes, y);
  append(bytes, z);
  append(bytes, std::uint8_t{10});
  append(bytes, std::uint16_t{31});
  append(bytes, std::uint32_t{123456});
  append(bytes, label);
}

std::string our_file() {
  std::string content = kOurHeader;
  append_point(content, 1.0F, 2.0F, 3.0F, 1);
  append_point(content, -1.0F, -2.0F, -3.0F, 0);
  return content;
}

TEST_F(PcdReader, ReadsOurScans) {
  const PcdCloud cloud = read(our_file());
  EXPECT_THAT(cloud.x, ElementsAre(1.0F, -1.0F));
  EXPECT_THAT(cloud.y, ElementsAre(2.0F, -2.0F));
  EXPECT_THAT(cloud.z, ElementsAre(3.0F, -3.0F));
  EXPECT_THAT(cloud.label, ElementsAre(Label::structure, Label::other));
}

TEST_F(PcdReader, AFileWithoutLabelsHasNone) {
  const PcdCloud cloud =
      read("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nPOINTS 1\nDATA ascii\n1 2 3\n");
  EXPECT_EQ(cloud.view().size(), 1U);
  EXPECT_THAT(cloud.label, IsEmpty());
}

TEST_F(PcdReader, TakesFieldsInAnyOrderAndSkipsOthers) {
  std::string content =
      "FIELDS normal z label y x\nSIZE 4 8 2 4 4\nTYPE F F I F F\nCOUNT 3 1 1 1 1\nPOINTS 1\n"
      "DATA binary\n";
  for (int i = 0; i < 3; ++i) append(content, 9.0F);
  append(content, 3.5);
  append(content, std::int16_t{1});
  append(content, 2.0F);
  append(content, 1.0F);
  const PcdCloud cloud = read(content);
  EXPECT_THAT(cloud.x, ElementsAre(1.0F));
  EXPECT_THAT(cloud.y, ElementsAre(2.0F));
  EXPECT_THAT(cloud.z, ElementsAre(3.5F));
  EXPECT_THAT(cloud.label, ElementsAre(Label::structure));
}

TEST_F(PcdReader, ReadsTextWithWindowsLineEndsAndNotANumber) {
  const PcdCloud cloud = read(
      "VERSION 0.7\r\nFIELDS x y z label\r\nSIZE 4 4 4 1\r\nTYPE F F F U\r\nCOUNT 1 1 1 1\r\n"
      "POINTS 2\r\nDATA ascii\r\n1.5 -2e-1 3 1\r\nnan nan nan 0\r\n");
  EXPECT_FLOAT_EQ(cloud.y[0], -0.2F);
  EXPECT_TRUE(std::isnan(cloud.x[1]));
  EXPECT_THAT(cloud.label, ElementsAre(Label::structure, Label::other));
}

TEST_F(PcdReader, CountDefaultsToOne) {
  const PcdCloud cloud =
      read("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3\n");
  EXPECT_THAT(cloud.z, ElementsAre(3.0F));
}

TEST_F(PcdReader, NamesAFileThatIsNotThere) {
  try {
    (void)read_pcd("/nonexistent/scan.pcd");
    FAIL() << "expected an exception";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("/nonexistent/scan.pcd: cannot open"));
  }
}

TEST_F(PcdReader, RefusesWhatIsNoPcdFile) {
  EXPECT_THAT(error(""), HasSubstr("not a PCD file"));
  EXPECT_THAT(error("ply\nformat ascii 1.0\n"), HasSubstr("line 1: expected a PCD header"));
  EXPECT_THAT(error(std::string("\xD4\xC3\xB2\xA1\x02\x00\x04\x00", 8)),
              HasSubstr("line 1: expected a PCD header"));
}

TEST_F(PcdReader, SaysWhichFieldIsMissing) {
  EXPECT_THAT(error("FIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nPOINTS 0\nDATA binary\n"),
              HasSubstr("found no z"));
}

TEST_F(PcdReader, RefusesCompressedData) {
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA binary_compressed\nabc"),
              HasSubstr("found DATA binary_compressed"));
}

TEST_F(PcdReader, ATruncatedFileIsAnError) {
  std::string content = our_file();
  content.pop_back();
  EXPECT_THAT(error(content),
              HasSubstr("expected 2 points of 20 bytes after the header, found 39 bytes"));
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 2\nDATA ascii\n1 2 3\n"),
              HasSubstr("expected 2 points, found 1"));
}

TEST_F(PcdReader, APointCountBeyondTheFileAllocatesNothing) {
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 18446744073709551615\n"
                    "DATA binary\nabcd"),
              HasSubstr("found 4 bytes"));
}

TEST_F(PcdReader, NamesTheLineOfAWrongNumber) {
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 two 3\n"),
              HasSubstr("line 6: expected a number for y"));
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 0 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3\n"),
              HasSubstr("line 2: expected SIZE"));
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS many\nDATA ascii\n1 2 3\n"),
              HasSubstr("line 4: expected a number after POINTS"));
}

TEST_F(PcdReader, RefusesCoordinatesOfAnotherType) {
  EXPECT_THAT(error("FIELDS x y z\nSIZE 4 2 4\nTYPE F U F\nPOINTS 1\nDATA ascii\n1 2 3\n"),
              HasSubstr("field y: expected TYPE F"));
}

TEST_F(PcdReader, ReadsARevolutionOfAnotherProgram) {
  CONVEXCUT_NEEDS_RECORDING(revolution, "lidar/hdl32e_revolution.pcd");
  const PcdCloud cloud = read_pcd(revolution);
  EXPECT_EQ(cloud.view().size(), 69'088U);
  EXPECT_THAT(cloud.label, IsEmpty());
}

}  // namespace
}  // namespace convexcut::replay
