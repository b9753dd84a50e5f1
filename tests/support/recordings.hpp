// SPDX-License-Identifier: Apache-2.0
//
// Real recordings are not part of the repository: tests that need them skip, and say so, where the
// folder is absent (CONVEXCUT_RECORDINGS names another place).
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace convexcut::test {

// The path of a recording, e.g. "lidar/hdl32e_courtyard_2011.pcap"; it may not exist.
[[nodiscard]] std::filesystem::path recording(std::string_view relative);

[[nodiscard]] std::vector<std::byte> read_bytes(const std::filesystem::path& file);

// "FA FF 30 00 D1" → bytes; anything but hex digits separates.
[[nodiscard]] std::vector<std::byte> hex(std::string_view text);

// A folder of its own for a test, removed at the end.
class TemporaryDirectory {
 public:
  TemporaryDirectory();
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace convexcut::test

// Skips the test when the recording is not there.
#define CONVEXCUT_NEEDS_RECORDING(variable, relative)                            \
  const std::filesystem::path variable = ::convexcut::test::recording(relative); \
  if (!std::filesystem::exists(variable))                                        \
  GTEST_SKIP() << "needs the recording " << (relative) << ", which is not here"
