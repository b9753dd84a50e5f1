// SPDX-License-Identifier: Apache-2.0
//
// `convexcut simulate` as a user runs it, and `convexcut process` on what it wrote. Does not prove
// what is in the files (replay_simulation_test does).
#include <cmath>
#include <sstream>

#include <gmock/gmock.h>

#include "replay/pcd_reader.hpp"
#include "tests/support/room.hpp"

namespace convexcut::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kRoom = R"([rig]
position = [3.0, 2.0, 1.2]
[[room]]
name = "room"
min = [0, 0, 0]
max = [8, 6, 3]
)";

class Simulate : public RoomTest {
 protected:
  [[nodiscard]] ProgramResult simulate(const std::vector<std::string>& arguments,
                                       const ProgramLimits& limits = {}) const {
    std::vector<std::string> all{"simulate", "--scene", scene(), "--out", room().string()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run_program("convexcut", all, limits);
  }
  [[nodiscard]] std::string scene() const {
    write(path("room.toml"), kRoom);
    return path("room.toml").string();
  }
  // Nothing under the final name, and no remains.
  [[nodiscard]] bool left_nothing() const {
    return !std::filesystem::exists(room()) && !std::filesystem::exists(room().string() + ".part");
  }
};

TEST_F(Simulate, WritesTheFilesOfARecordingAndItsTruth) {
  const ProgramResult made = simulate({"--seconds", "0.2"});
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_THAT(names(room()),
              ElementsAre("can.log", "convexcut.toml", "imu.pcap", "lidar.pcap", "truth"));
  EXPECT_THAT(names(room() / "truth"), ElementsAre("poses.csv", "returns.bin", "simulation.toml"));
  EXPECT_THAT(made.out, HasSubstr("361 packets"));
}

TEST_F(Simulate, ProcessFindsItsScansAndTheirWallsUpright) {
  ASSERT_EQ(simulate({"--seconds", "0.5", "--tilt-deg", "30", "--rotation-dps", "45"}).status, 0);
  const ProgramResult run = process(
      {"--config", (room() / "convexcut.toml").string(), "--lidar", lidar(), "--imu", imu()});
  ASSERT_EQ(run.status, 0) << run.err;
  std::istringstream csv(text(path("scans") / "scans.csv"));
  std::string line;
  int rows = -1;  // the header
  while (std::getline(csv, line)) ++rows;
  EXPECT_EQ(rows, 6);  // four whole revolutions and the partial ones at both ends
  const replay::PcdCloud cloud = replay::read_pcd(path("scans") / "scan_000002.pcd");
  ASSERT_GT(cloud.x.size(), 60'000U);
  std::size_t on_sides = 0;
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    const Vec3f p = Vec3f(3.0F, 2.0F, 1.2F) + Vec3f(cloud.x[i], cloud.y[i], cloud.z[i]);
    const float off =
        std::min(p.cwiseAbs().minCoeff(), (p - Vec3f(8.0F, 6.0F, 3.0F)).cwiseAbs().minCoeff());
    // Noise of 2 cm, and 0.3° of the IMU's error over some metres.
    on_sides += off < 0.08F ? 1U : 0U;
  }
  EXPECT_GT(on_sides, cloud.x.size() * 99 / 100);
}

TEST_F(Simulate, ProcessTakesTheCanImuAsWell) {
  ASSERT_EQ(simulate({"--seconds", "0.3"}).status, 0);
  const ProgramResult run = process({"--lidar", lidar(), "--can", can()});
  EXPECT_EQ(run.status, 0) << run.err;
}

TEST_F(Simulate, TheSameArgumentsGiveTheSameBytes) {
  const std::vector<std::string> arguments{"--seconds", "0.2",    "--sway", "2",
                                           "--ghosts",  "0.01",   "--dual", "--loss",
                                           "0.01",      "--seed", "9"};
  const auto bytes = [&] {
    EXPECT_EQ(simulate(arguments).status, 0);
    std::string all;
    for (const char* file : {"lidar.pcap", "imu.pcap", "can.log", "truth/returns.bin",
                             "truth/poses.csv", "truth/simulation.toml"}) {
      all += text(room() / file);
    }
    std::filesystem::remove_all(room());
    return all;
  };
  const std::string first = bytes();
  EXPECT_GT(first.size(), 1'000'000U);
  EXPECT_EQ(first, bytes());
}

TEST_F(Simulate, TellsItsSummaryAsJsonAndDrawsARevolution) {
  const ProgramResult made = simulate(
      {"--seconds", "0.3", "--json", "--ghosts", "0.1", "--picture", path("p.png").string()});
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_THAT(made.out, AllOf(HasSubstr("\"packets\": 542,"), HasSubstr("\"seed\": 1,"),
                              HasSubstr("\"times_real_time\": ")));
  EXPECT_EQ(text(path("p.png")).substr(1, 3), "PNG");
}

TEST_F(Simulate, AnUnknownSceneIsWrongUsageAndTheKnownOnesAreNamed) {
  const ProgramResult run =
      run_program("convexcut", {"simulate", "--scene", "offices", "--out", room().string()});
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(run.error_lines(), 1U) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("unknown scene \"offices\""), HasSubstr("office")));
  EXPECT_TRUE(left_nothing());
}

TEST_F(Simulate, AWrongSceneFileIsToldLineByLine) {
  write(path("wrong.toml"), "[rig]\nposition = [0, 0, 1]\n[[room]]\nmin = [0, 0, 0]\nmax = 7\n");
  const ProgramResult run = run_program(
      "convexcut", {"simulate", "--scene", path("wrong.toml").string(), "--out", room().string()});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, HasSubstr("wrong.toml:5: "));
  EXPECT_TRUE(left_nothing());
}

TEST_F(Simulate, AFolderThatIsThereIsNotTouched) {
  std::filesystem::create_directory(room());
  write(room() / "mine", "keep");
  const ProgramResult run = simulate({"--seconds", "0.2"});
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(run.error_lines(), 1U) << run.err;
  EXPECT_THAT(run.err, HasSubstr("exists already"));
  EXPECT_THAT(names(room()), ElementsAre("mine"));
}

TEST_F(Simulate, RemainsOfAnInterruptedRunAreNotMixedIn) {
  std::filesystem::create_directory(room().string() + ".part");
  const ProgramResult run = simulate({"--seconds", "0.2"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, HasSubstr("interrupted; remove it"));
}

TEST_F(Simulate, WrongArgumentsAreRefusedInOneLine) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{"--path", "1,2;3"}, "--path: expected way points"},
      {{"--path", "1,2;1,2"}, "--path: expected way points"},
      {{"--path", "1,2,3,4"}, "--path: expected way points"},
      {{"--travel"}, "has no path"},
      {{"--lidar-ppm", "20"}, "expected --no-pps"},
      {{"--rotor-hz", "50"}, "--rotor-hz"},
      {{"--noise-m", "-1"}, "--noise-m"},
      {{"--people", "3"}, "people"},
      {{"--seconds", "0"}, "--seconds"},
      {{"--path-end", "sideways"}, "--path-end"},
      {{"--frobnicate"}, "--frobnicate"}};
  for (const auto& [arguments, expected] : wrong) {
    const ProgramResult run = simulate(arguments);
    EXPECT_EQ(run.status, 2) << expected;
    EXPECT_EQ(run.error_lines(), 1U) << run.err;
    EXPECT_THAT(run.err, HasSubstr(expected));
    EXPECT_TRUE(left_nothing());
  }
}

TEST_F(Simulate, AFullDiskLeavesNothing) {
  const ProgramResult run =
      simulate({"--seconds", "1"}, {.terminate_at = {}, .file_size_bytes = 300'000});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.error_lines(), 1U) << run.err;
  EXPECT_TRUE(left_nothing());
}

TEST_F(Simulate, ARigMayTravelAlongAPathOfItsOwn) {
  ASSERT_EQ(simulate({"--seconds", "0.3", "--path", "3,2;5,4,1.5", "--speed-m-s", "2"}).status, 0);
  const std::string poses = text(room() / "truth" / "poses.csv");
  const std::string last = poses.substr(poses.rfind('\n', poses.size() - 2) + 1);
  std::istringstream fields(last.substr(last.find(',') + 1));
  double x = 0;
  fields >> x;
  EXPECT_GT(x, 3.05);
}

}  // namespace
}  // namespace convexcut::test
