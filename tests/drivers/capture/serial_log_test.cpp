// SPDX-License-Identifier: Apache-2.0
//
// Raw serial recordings in chunks. Does not prove the answer to a device that fails while reading:
// a test cannot make one.
#include "drivers/capture/serial_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/drivers/capture/capture_bytes.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::capture {
namespace {

using test::Octets;
using ::testing::HasSubstr;

std::string error_of(const std::filesystem::path& path) {
  try {
    const SerialLog log(path);
  } catch (const CaptureError& error) {
    return error.what();
  }
  ADD_FAILURE() << "opened " << path;
  return {};
}

TEST(SerialLog, ChunksTogetherAreTheFile) {
  const test::TemporaryDirectory folder;
  Octets bytes;
  for (std::size_t i = 0; i < 2 * SerialLog::kChunkSize + 17; ++i) {
    bytes.push_back(static_cast<std::byte>(i * 7));
  }
  test::write_file(folder.path() / "imu.bin", bytes);
  SerialLog log(folder.path() / "imu.bin");
  Octets together;
  std::span<const std::byte> chunk;
  while (log.next(chunk) == ReadStatus::record) {
    EXPECT_LE(chunk.size(), SerialLog::kChunkSize);
    together.insert(together.end(), chunk.begin(), chunk.end());
  }
  EXPECT_EQ(together, bytes);
  EXPECT_EQ(log.bytes_read(), bytes.size());
  EXPECT_EQ(log.file_size(), bytes.size());
  EXPECT_EQ(log.next(chunk), ReadStatus::end);
  EXPECT_TRUE(chunk.empty());
  EXPECT_EQ(log.problem(), "");
}

TEST(SerialLog, MissingEmptyAndDirectoryAreErrorsOfOneLine) {
  const test::TemporaryDirectory folder;
  test::write_file(folder.path() / "empty.bin", {});
  EXPECT_THAT(error_of(folder.path() / "none.bin"),
              HasSubstr("none.bin: cannot open: No such file"));
  EXPECT_THAT(error_of(folder.path() / "empty.bin"), HasSubstr("empty.bin: is empty"));
  EXPECT_THAT(error_of(folder.path()), HasSubstr(": is a directory"));
}

TEST(SerialLog, RecordingIsReadWhole) {
  CONVEXCUT_NEEDS_RECORDING(path, "imu/mti_g710_1.bin");
  SerialLog log(path);
  std::span<const std::byte> chunk;
  while (log.next(chunk) == ReadStatus::record) {
  }
  EXPECT_EQ(log.bytes_read(), std::filesystem::file_size(path));
}

}  // namespace
}  // namespace convexcut::capture
