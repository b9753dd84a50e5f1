// SPDX-License-Identifier: Apache-2.0
//
// `convexcut process` as a user runs it, on a generated room. Does not prove that the labels are
// right (the engine's tests do), nor anything about live input.
#include <algorithm>
#include <sstream>

#include "core/simd/simd_path.hpp"
#include "tests/support/room.hpp"

namespace convexcut::test {
namespace {

using ::testing::Test;

class Process : public RoomTest {
 protected:
  struct Row {
    std::uint64_t index = 0;
    std::int64_t stamp_ns = 0;
    std::uint64_t points = 0;
    std::uint64_t structure = 0;
    double coverage = 0.0;
    std::int64_t latency_us = 0;
  };
  [[nodiscard]] std::vector<Row> scans() const {
    std::istringstream csv(text(path("scans") / "scans.csv"));
    std::string line;
    std::getline(csv, line);
    EXPECT_EQ(line, "index,stamp_ns,points,structure,coverage,latency_us");
    std::vector<Row> rows;
    while (std::getline(csv, line)) {
      std::replace(line.begin(), line.end(), ',', ' ');
      std::istringstream fields(line);
      Row row;
      fields >> row.index >> row.stamp_ns >> row.points >> row.structure >> row.coverage >>
          row.latency_us;
      EXPECT_FALSE(fields.fail()) << line;
      rows.push_back(row);
    }
    return rows;
  }
  [[nodiscard]] std::string all_bytes() const {
    std::string bytes;
    for (const std::string& name : names(out())) bytes += name + text(path("scans") / name);
    return bytes;
  }
};

TEST_F(Process, WritesAFileAScanAndTheirList) {
  make_room({"--seconds", "0.5"});
  const ProgramResult run = process({"--lidar", lidar(), "--imu", imu()});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto rows = scans();
  ASSERT_EQ(rows.size(), 6U);  // whole revolutions and the partial ones at both ends
  std::vector<std::string> expected;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    expected.push_back("scan_00000" + std::to_string(i) + ".pcd");
    EXPECT_EQ(rows[i].index, i);
    EXPECT_LE(rows[i].structure, rows[i].points);
    if (i > 0) {
      EXPECT_GT(rows[i].stamp_ns, rows[i - 1].stamp_ns);
    }
  }
  expected.emplace_back("scans.csv");
  EXPECT_EQ(names(out()), expected);
  EXPECT_LT(rows.front().coverage, 0.9);
  EXPECT_NEAR(rows[2].coverage, 1.0, 0.001);
  EXPECT_LT(rows.back().coverage, 0.9);
}

TEST_F(Process, IsBitIdenticalOnEveryRunAndForEveryNumberOfThreads) {
  make_room({"--seconds", "0.4"});
  ASSERT_EQ(process({"--lidar", lidar(), "--imu", imu(), "--threads", "1"}).status, 0);
  const std::string first = all_bytes();
  ASSERT_GT(first.size(), 1'000'000U);
  for (const std::string threads : {"1", "2", "3", "8"}) {
    std::filesystem::remove_all(out());
    ASSERT_EQ(process({"--lidar", lidar(), "--imu", imu(), "--threads", threads}).status, 0);
    EXPECT_TRUE(all_bytes() == first) << threads << " threads";
  }
}

TEST_F(Process, IsBitIdenticalOnEveryInstructionSet) {
  make_room({"--seconds", "0.4"});
  ASSERT_EQ(process({"--lidar", lidar(), "--imu", imu()}).status, 0);
  const std::string best = all_bytes();
  for (const std::string_view simd : simd_paths()) {
    const std::string forced = "convex_cut.simd=" + std::string(simd);
    ASSERT_EQ(process({"--lidar", lidar(), "--imu", imu(), "--set", forced}).status, 0);
    EXPECT_TRUE(all_bytes() == best) << simd;
  }
}

TEST_F(Process, AnInstructionSetThatTheProcessorLacksIsWrongUsage) {
  const auto paths = simd_paths();
  const std::string missing = std::ranges::find(paths, "neon") == paths.end() ? "neon" : "avx2";
  const ProgramResult run =
      run_program("convexcut", {"info", "--cpu", "--set", "convex_cut.simd=" + missing});
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(run.error_lines(), 1U);
  EXPECT_NE(run.err.find(missing), std::string::npos) << run.err;
}

TEST_F(Process, PcdHasTheContractsHeaderAndSize) {
  make_room({"--seconds", "0.2"});
  ASSERT_EQ(process({"--lidar", lidar(), "--imu", imu()}).status, 0);
  const std::string pcd = text(path("scans") / "scan_000001.pcd");
  const std::size_t data = pcd.find("DATA binary\n");
  ASSERT_NE(data, std::string::npos);
  const std::string header = pcd.substr(0, data);
  EXPECT_NE(header.find("VERSION 0.7\nFIELDS x y z intensity ring time label\nSIZE 4 4 4 1 2 4 1\n"
                        "TYPE F F F U U U U\nCOUNT 1 1 1 1 1 1 1\n"),
            std::string::npos);
  const std::uint64_t points = scans().at(1).points;
  EXPECT_NE(header.find("POINTS " + std::to_string(points) + "\n"), std::string::npos);
  EXPECT_EQ(pcd.size() - data - 12, points * 20);
}

TEST_F(Process, PlyAndCsvHoldTheSamePoints) {
  make_room({"--seconds", "0.2"});
  ASSERT_EQ(process({"--lidar", lidar(), "--imu", imu(), "--format", "ply"}).status, 0);
  ASSERT_EQ(process({"--lidar", lidar(), "--imu", imu(), "--format", "csv"}).status, 0);
  ASSERT_EQ(process({"--lidar", lidar(), "--imu", imu(), "--format", "pcd"}).status, 0);
  const std::string pcd = text(path("scans") / "scan_000001.pcd");
  const std::string ply = text(path("scans") / "scan_000001.ply");
  const std::string csv = text(path("scans") / "scan_000001.csv");
  EXPECT_EQ(pcd.substr(pcd.find("DATA binary\n") + 12), ply.substr(ply.find("end_header\n") + 11));
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "x,y,z,intensity,ring,time,label");
  EXPECT_EQ(static_cast<std::uint64_t>(std::count(csv.begin(), csv.end(), '\n')),
            scans().at(1).points + 1);
}

TEST_F(Process, TheSameMotionOverCanGivesNearlyTheSameStructure) {
  make_room({"--seconds", "0.4"});
  ASSERT_EQ(process({"--lidar", lidar(), "--imu", imu()}).status, 0);
  const auto serial = scans();
  ASSERT_EQ(process({"--lidar", lidar(), "--can", can()}).status, 0);
  const auto bus = scans();
  ASSERT_EQ(serial.size(), bus.size());
  EXPECT_NEAR(static_cast<double>(serial[2].structure), static_cast<double>(bus[2].structure),
              0.01 * static_cast<double>(serial[2].points));
}

TEST_F(Process, AFixedMountNeedsNoImu) {
  make_room({"--seconds", "0.2", "--tilt-deg", "0", "--turn-deg-s", "0"});
  const ProgramResult run = process({"--lidar", lidar(), "--set", "mount.orientation=fixed"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
}

TEST_F(Process, CourtyardHasTwoWholeRevolutionsOfTheKnownReturns) {
  CONVEXCUT_NEEDS_RECORDING(courtyard, "lidar/hdl32e_courtyard_2011.pcap");
  const ProgramResult run =
      process({"--lidar", courtyard.string(), "--set", "mount.orientation=fixed", "--set",
               "lidar.min_range_m=0", "--set", "lidar.max_range_m=200"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto rows = scans();
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0].points, 23'216U);
  EXPECT_EQ(rows[1].points, 57'734U);
  EXPECT_EQ(rows[2].points, 57'882U);
  EXPECT_EQ(rows[3].points, 7'873U);
  EXPECT_EQ(rows[1].coverage, 1.0);
  EXPECT_LT(rows[0].coverage, 0.5);
  EXPECT_LT(rows[3].coverage, 0.2);
}

TEST_F(Process, JsonSummaryIsOneObjectOnStdout) {
  make_room({"--seconds", "0.2"});
  const ProgramResult run = process({"--lidar", lidar(), "--imu", imu(), "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out.front(), '{');
  EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 1);
  EXPECT_NE(run.out.find("\"lost_packets\": 0"), std::string::npos);
}

TEST_F(Process, ScanFilesOfALongerEarlierRunAreReported) {
  make_room({"--seconds", "0.2"});
  std::filesystem::create_directories(out());
  write(path("scans") / "scan_000003.pcd", "of an earlier run");
  const ProgramResult run = process({"--lidar", lidar(), "--imu", imu()});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.err.find("1 scan files of an earlier run"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace convexcut::test
