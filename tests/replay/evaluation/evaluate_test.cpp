// SPDX-License-Identifier: Apache-2.0
//
// `convexcut evaluate` as users run it, on short simulated recordings. Does not prove that the
// figures of a method are good: that the right ones are printed.
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

#include "replay/simulation/recording.hpp"
#include "tests/support/room.hpp"

namespace convexcut::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr int kFailed = 1;
constexpr int kUsage = 2;

// A room with a box in it. Two revolutions of it are simulated and processed once for all tests.
constexpr const char* kScene = R"(
[rig]
position = [0.0, 0.0, 1.1]
[[room]]
name = "room"
min = [-3.0, -2.5, 0.0]
max = [3.5, 2.0, 2.5]
[[box]]
name = "crate"
label = "object"
min = [1.5, -0.5, 0.0]
max = [2.0, 0.5, 1.2]
)";

constexpr std::size_t kPointBytes = 20;
constexpr std::size_t kLabelOffset = 19;

class Evaluate : public RoomTest {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryDirectory;
    simulate("sim", 1);
    const ProgramResult made =
        run_program("convexcut", {"process", "--lidar", shared("sim/lidar.pcap"), "--imu",
                                  shared("sim/imu.pcap"), "--config", shared("sim/convexcut.toml"),
                                  "--out", shared("scans")});
    ASSERT_EQ(made.status, 0) << made.err;
  }
  static void TearDownTestSuite() { delete folder_; }

  static void simulate(const std::string& name, std::uint64_t seed) {
    using namespace simulation;
    std::filesystem::create_directories(shared(name));
    const Scene scene = Scene::parse(kScene, "small.toml");
    SimulationOptions options;
    options.length = std::chrono::milliseconds{260};
    options.seed = seed;
    options.rig = planned_rig(scene, false);
    options.lidar.ghosts = 0.002;
    write_recording(scene, options, shared(name), [](std::uint64_t, std::uint64_t) {});
  }
  [[nodiscard]] static std::string shared(const std::string& name) {
    return (folder_->path() / name).string();
  }

  // A copy of the result that a test may damage.
  [[nodiscard]] std::string copied_result() const {
    std::filesystem::copy(shared("scans"), path("scans"));
    return path("scans").string();
  }
  [[nodiscard]] static ProgramResult evaluate(const std::vector<std::string>& arguments) {
    std::vector<std::string> all{"evaluate"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run_program("convexcut", all);
  }
  static void expect_failure(const ProgramResult& run, int status,
                             const std::vector<std::string>& what) {
    EXPECT_EQ(run.status, status) << run.err;
    EXPECT_EQ(run.error_lines(), 1U) << run.err;
    for (const std::string& part : what) EXPECT_THAT(run.err, HasSubstr(part));
    EXPECT_EQ(run.out, "");
  }
  // The first number behind a member's name.
  [[nodiscard]] static double number(const std::string& json, const std::string& member) {
    const std::size_t at = json.find("\"" + member + "\": ");
    return at == std::string::npos ? -1.0 : std::stod(json.substr(at + member.size() + 4));
  }

 private:
  static inline TemporaryDirectory* folder_ = nullptr;
};

TEST_F(Evaluate, PrintsATableAndWritesJsonAndHtml) {
  const ProgramResult run =
      evaluate({"--truth", shared("sim"), "--result", shared("scans"), "--json",
                path("all.json").string(), "--html", path("all.html").string()});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(run.out, HasSubstr("scene    small, seed 1"));
  EXPECT_THAT(run.out, HasSubstr("points   precision"));
  EXPECT_THAT(run.out, HasSubstr("patches  recall"));

  const std::string json = text(path("all.json"));
  EXPECT_THAT(json, StartsWith("{\"scene\": \"small\", \"seed\": 1, "));
  EXPECT_GE(number(json, "scans_evaluated"), 1.0);
  EXPECT_GE(number(json, "scans_left_out"), 1.0);
  EXPECT_EQ(number(json, "unmatched_points"), 0.0);
  EXPECT_GT(number(json.substr(json.find("points_pooled")), "f"), 0.8);
  EXPECT_THAT(json, HasSubstr("\"name\": \"crate\", \"label\": \"object\""));

  const std::string html = text(path("all.html"));
  EXPECT_THAT(html, StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(html, HasSubstr("</html>"));
  EXPECT_THAT(html, HasSubstr("<svg"));
  EXPECT_THAT(html, HasSubstr("data:image/png;base64,iVBOR"));
  // Nothing outside of the file is asked for.
  EXPECT_THAT(html, Not(HasSubstr("http")));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
}

TEST_F(Evaluate, IsTheSameEveryTime) {
  for (const char* name : {"a", "b"}) {
    const ProgramResult run =
        evaluate({"--truth", shared("sim/truth"), "--result", shared("scans"), "--title", "t",
                  "--json", path(std::string(name) + ".json").string(), "--html",
                  path(std::string(name) + ".html").string()});
    ASSERT_EQ(run.status, 0) << run.err;
  }
  EXPECT_EQ(text(path("a.json")), text(path("b.json")));
  EXPECT_EQ(text(path("a.html")), text(path("b.html")));
}

TEST_F(Evaluate, WithoutAnyLabelOfStructureRecallIsNothing) {
  const std::string scans = copied_result();
  for (const std::string& name : names(scans)) {
    if (!name.ends_with(".pcd")) continue;
    const std::filesystem::path file = std::filesystem::path(scans) / name;
    std::string bytes = text(file);
    const std::size_t data = bytes.find("DATA binary\n") + 12;
    for (std::size_t at = data + kLabelOffset; at < bytes.size(); at += kPointBytes) bytes[at] = 0;
    write(file, bytes);
  }
  const ProgramResult run = evaluate({"--truth", shared("sim"), "--result", scans, "--json",
                                      path("none.json").string(), "--quiet"});
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string json = text(path("none.json"));
  const std::string pooled = json.substr(json.find("points_pooled"));
  EXPECT_EQ(number(pooled, "recall"), 0.0);
  EXPECT_EQ(number(pooled, "true_positive"), 0.0);
  EXPECT_GT(number(pooled, "false_negative"), 1000.0);
}

TEST_F(Evaluate, PointsAreFoundThoughTheResultsClockIsWrong) {
  const std::string scans = copied_result();
  std::istringstream rows(text(std::filesystem::path(scans) / "scans.csv"));
  std::string moved;
  for (std::string row; std::getline(rows, row);) {
    const std::size_t first = row.find(',');
    const std::size_t second = row.find(',', first + 1);
    if (std::isdigit(row[0]) != 0) {
      const std::int64_t stamp = std::stoll(row.substr(first + 1)) + 3'210'000;  // 3.21 ms
      row = row.substr(0, first + 1) + std::to_string(stamp) + row.substr(second);
    }
    moved += row + "\n";
  }
  write(std::filesystem::path(scans) / "scans.csv", moved);
  const ProgramResult run =
      evaluate({"--truth", shared("sim"), "--result", scans, "--json", path("late.json").string()});
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string json = text(path("late.json"));
  EXPECT_EQ(number(json, "unmatched_points"), 0.0);
  EXPECT_NEAR(number(json, "clock_offset_us"), 3210.0, 300.0);
}

TEST_F(Evaluate, TruthOfAnotherRunDoesNotBelong) {
  simulate("other", 2);
  expect_failure(evaluate({"--truth", shared("other"), "--result", shared("scans")}), kFailed,
                 {"do not belong together", "scan", "other"});
}

TEST_F(Evaluate, TruthOfAnotherTimeDoesNotBelong) {
  const std::string scans = copied_result();
  write(std::filesystem::path(scans) / "scans.csv",
        "index,stamp_ns,points,structure,coverage,latency_us\n1,1000000000,10,5,1.0,0\n");
  expect_failure(evaluate({"--truth", shared("sim"), "--result", scans}), kFailed,
                 {"do not belong together", "1970-01-01"});
}

TEST_F(Evaluate, SaysWhatIsMissing) {
  expect_failure(evaluate({"--result", shared("scans")}), kUsage, {"--truth"});
  expect_failure(evaluate({"--truth", path("no").string(), "--result", shared("scans")}), kFailed,
                 {"no/simulation.toml", "No such file"});
  expect_failure(evaluate({"--truth", shared("sim"), "--result", path("no").string()}), kFailed,
                 {"no/scans.csv", "No such file", "convexcut process"});
  const std::string scans = copied_result();
  std::filesystem::remove(std::filesystem::path(scans) / "scan_000001.pcd");
  expect_failure(evaluate({"--truth", shared("sim"), "--result", scans}), kFailed,
                 {"scan_000001.pcd", "cannot open"});
}

TEST_F(Evaluate, RefusesAResultWithoutWholeScans) {
  const std::string scans = copied_result();
  const std::filesystem::path csv = std::filesystem::path(scans) / "scans.csv";
  const std::string header = "index,stamp_ns,points,structure,coverage,latency_us\n";
  write(csv, header);
  expect_failure(evaluate({"--truth", shared("sim"), "--result", scans}), kFailed,
                 {"scans.csv", "no scan"});
  write(csv, header + "0,1,2\n");
  expect_failure(evaluate({"--truth", shared("sim"), "--result", scans}), kFailed,
                 {"scans.csv:2", "expected numbers"});
  write(csv, "index\n");
  expect_failure(evaluate({"--truth", shared("sim"), "--result", scans}), kFailed,
                 {"scans.csv:1", "header"});
  expect_failure(
      evaluate({"--truth", shared("sim"), "--result", shared("scans"), "--least-coverage", "2"}),
      kUsage, {"--least-coverage"});
}

TEST_F(Evaluate, RefusesScansThatCannotBeRead) {
  const std::string scans = copied_result();
  const std::filesystem::path file = std::filesystem::path(scans) / "scan_000001.pcd";
  const std::string good = text(file);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string bytes = good;
    return bytes.replace(bytes.find(from), from.size(), to);
  };
  write(file, good.substr(0, good.size() / 2));
  expect_failure(evaluate({"--truth", shared("sim"), "--result", scans}), kFailed,
                 {"scan_000001.pcd", "points"});
  write(file, "nothing of the kind");
  expect_failure(evaluate({"--truth", shared("sim"), "--result", scans}), kFailed,
                 {"scan_000001.pcd", "PCD"});
  write(file, with(" label\n", " other\n"));
  expect_failure(evaluate({"--truth", shared("sim"), "--result", scans}), kFailed,
                 {"scan_000001.pcd", "label"});
  write(file, with(" ring ", " rung "));
  expect_failure(evaluate({"--truth", shared("sim"), "--result", scans}), kFailed,
                 {"scan_000001.pcd", "ring and time"});
}

TEST_F(Evaluate, RefusesOtherFormatsThanPcd) {
  const std::string scans = copied_result();
  for (const std::string& name : names(scans)) {
    if (!name.ends_with(".pcd")) continue;
    const std::filesystem::path file = std::filesystem::path(scans) / name;
    std::filesystem::rename(file, std::filesystem::path(file).replace_extension("ply"));
  }
  expect_failure(evaluate({"--truth", shared("sim"), "--result", scans}), kFailed,
                 {"ply", "--format pcd"});
}

TEST_F(Evaluate, ADamagedTruthIsAnError) {
  std::filesystem::copy(shared("sim"), path("sim"), std::filesystem::copy_options::recursive);
  const std::filesystem::path returns = path("sim") / "truth" / "returns.bin";
  std::filesystem::resize_file(returns, std::filesystem::file_size(returns) / 2);
  expect_failure(evaluate({"--truth", path("sim").string(), "--result", shared("scans")}), kFailed,
                 {"returns.bin", "firings"});
}

TEST_F(Evaluate, LeavesNoReportThatIsNotWhole) {
  const ProgramResult run = evaluate({"--truth", shared("sim"), "--result", shared("scans"),
                                      "--html", path("no/report.html").string()});
  EXPECT_EQ(run.status, kFailed);
  EXPECT_THAT(run.err, HasSubstr("no/report.html"));
  EXPECT_FALSE(std::filesystem::exists(path("no")));
}

}  // namespace
}  // namespace convexcut::test
