// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/recordings.hpp"
#include "tests/support/run_program.hpp"

namespace convexcut::test {

// A recorded room of its own for a test, and the programs run on it.
class RoomTest : public ::testing::Test {
 protected:
  void make_room(const std::vector<std::string>& arguments) {
    std::vector<std::string> all{"--out", room().string()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProgramResult made = run_program("convexcut-demo-room", all);
    ASSERT_EQ(made.status, 0) << made.err;
  }

  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return directory_.path() / name;
  }
  [[nodiscard]] std::filesystem::path room() const { return path("room"); }
  [[nodiscard]] std::string lidar() const { return (room() / "lidar.pcap").string(); }
  [[nodiscard]] std::string imu() const { return (room() / "imu.pcap").string(); }
  [[nodiscard]] std::string can() const { return (room() / "can.log").string(); }
  [[nodiscard]] std::string out() const { return path("scans").string(); }

  [[nodiscard]] ProgramResult process(const std::vector<std::string>& arguments,
                                      const ProgramLimits& limits = {}) const {
    std::vector<std::string> all{"process", "--out", out()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run_program("convexcut", all, limits);
  }

  [[nodiscard]] static std::string text(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static void write(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
  }
  // Names in a directory, sorted.
  [[nodiscard]] static std::vector<std::string> names(const std::filesystem::path& directory) {
    std::vector<std::string> found;
    if (!std::filesystem::exists(directory)) return found;
    for (const auto& entry : std::filesystem::directory_iterator(directory)) {
      found.push_back(entry.path().filename().string());
    }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  TemporaryDirectory directory_;
};

}  // namespace convexcut::test
