// SPDX-License-Identifier: Apache-2.0
//
// Segments on a real directory. Does not prove anything of losing power: what fsync() has promised
// is taken for true.
#include "drivers/recorder/recording_files.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/drivers/recorder/records.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::recorder {
namespace {

using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Files : public ::testing::Test {
 protected:
  [[nodiscard]] RecordingOptions options() const {
    RecordingOptions options;
    options.directory = folder_.path() / "rec";
    return options;
  }
  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return options().directory / name;
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(options().directory)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  void write_packets(RecordingFiles& files, int count) {
    for (int i = 0; i < count; ++i) {
      files.write(Stream::lidar, testing::datagram(number_, testing::payload_of(number_, 1206)),
                  now_);
      ++number_;
    }
  }

  test::TemporaryDirectory folder_;
  RecordingFiles::SteadyTime now_{seconds{100}};
  std::uint64_t number_ = 0;
};

TEST_F(Files, AppearWithTheFirstRecordOfTheirStream) {
  RecordingFiles files(options());
  EXPECT_THAT(names(), ElementsAre());
  write_packets(files, 1);
  EXPECT_THAT(names(), ElementsAre("lidar_000.pcap"));
  files.write(Stream::imu, testing::read_of(0, testing::payload_of(0, 40)), now_);
  EXPECT_THAT(names(), ElementsAre("imu_000.pcap", "lidar_000.pcap"));
  const auto payload = testing::payload_of(0, 16);
  capture::Record frame = testing::read_of(0, payload);
  frame.kind = capture::RecordKind::can;
  files.write(Stream::can, frame, now_);
  EXPECT_THAT(names(), ElementsAre("can_000.pcap", "imu_000.pcap", "lidar_000.pcap"));
  files.close();
  EXPECT_EQ(capture::CaptureReader(path("lidar_000.pcap")).link(), capture::LinkKind::ethernet);
  EXPECT_EQ(capture::CaptureReader(path("imu_000.pcap")).link(), capture::LinkKind::serial);
  EXPECT_EQ(capture::CaptureReader(path("can_000.pcap")).link(), capture::LinkKind::can);
}

TEST_F(Files, NumbersGoOnBehindWhatIsThere) {
  std::filesystem::create_directories(options().directory);
  for (const char* const name : {"imu_007.pcap", "lidar_002.pcap", "lidar_12.pcap",
                                 "lidar_099.pcap.part", "radar_500.pcap", "lidar_.pcap"}) {
    std::filesystem::copy_file("/proc/self/status", path(name));
  }
  RecordingFiles files(options());
  write_packets(files, 1);
  EXPECT_EQ(files.segment(), 8U);
  EXPECT_TRUE(std::filesystem::exists(path("lidar_008.pcap")));
}

TEST_F(Files, ASegmentEndsForAllStreamsWhenOneFileIsLargeEnough) {
  RecordingOptions limited = options();
  limited.max_file_bytes = 10'000;
  RecordingFiles files(limited);
  write_packets(files, 5);
  files.write(Stream::imu, testing::read_of(0, testing::payload_of(0, 40)), now_);
  files.maintain(now_);
  EXPECT_EQ(files.segment(), 0U);
  write_packets(files, 5);
  files.maintain(now_);
  EXPECT_EQ(files.segment(), 1U);
  files.write(Stream::imu, testing::read_of(1, testing::payload_of(1, 40)), now_);
  write_packets(files, 1);
  files.close();
  EXPECT_THAT(names(),
              ElementsAre("imu_000.pcap", "imu_001.pcap", "lidar_000.pcap", "lidar_001.pcap"));
  EXPECT_EQ(testing::content_of(path("lidar_000.pcap")).records, 10U);
  const auto next = testing::content_of(path("lidar_001.pcap"));
  EXPECT_EQ(next.first, 10U) << "nothing is lost between segments";
  EXPECT_EQ(next.wrong, 0U);
}

TEST_F(Files, ASegmentEndsWhenItIsOldEnough) {
  RecordingOptions limited = options();
  limited.max_file_time = seconds{60};
  RecordingFiles files(limited);
  now_ += seconds{1000};  // without a record, no segment gets older
  files.maintain(now_);
  EXPECT_EQ(files.segment(), 0U);
  write_packets(files, 1);
  now_ += seconds{59};
  files.maintain(now_);
  EXPECT_EQ(files.segment(), 0U);
  now_ += seconds{1};
  files.maintain(now_);
  EXPECT_EQ(files.segment(), 1U);
}

TEST_F(Files, OldestSegmentsAreDeletedAndOthersFilesAreNot) {
  RecordingOptions limited = options();
  limited.keep_bytes = 40'000;  // so that a segment ends with 10 000
  std::filesystem::create_directories(limited.directory);
  test::TemporaryDirectory elsewhere;
  for (const char* const name : {"notes.txt", "lidar_000.pcapng", "lidar.pcap"}) {
    std::filesystem::copy_file("/proc/self/status", path(name));
  }
  RecordingFiles files(limited);
  for (int segment = 0; segment < 10; ++segment) {
    write_packets(files, 9);  // 11 376 bytes
    files.write(Stream::imu, testing::read_of(0, testing::payload_of(0, 40)), now_);
    files.maintain(now_);
  }
  files.maintain(now_);
  EXPECT_THAT(names(), ElementsAre("imu_007.pcap", "imu_008.pcap", "imu_009.pcap", "lidar.pcap",
                                   "lidar_000.pcapng", "lidar_007.pcap", "lidar_008.pcap",
                                   "lidar_009.pcap", "notes.txt"));
  EXPECT_EQ(files.deleted_segments(), 7U);
}

TEST_F(Files, TheSegmentBeingWrittenIsNeverDeleted) {
  RecordingOptions limited = options();
  limited.keep_bytes = 1;
  RecordingFiles files(limited);
  write_packets(files, 5);
  files.maintain(now_);
  EXPECT_THAT(names(), ElementsAre("lidar_000.pcap"));
}

TEST_F(Files, BytesAreThoseOfTheFiles) {
  RecordingOptions limited = options();
  limited.max_file_bytes = 3000;
  RecordingFiles files(limited);
  for (int i = 0; i < 7; ++i) {
    write_packets(files, 1);
    files.maintain(now_);
  }
  files.close();
  std::uint64_t on_disk = 0;
  for (const auto& entry : std::filesystem::directory_iterator(limited.directory)) {
    on_disk += entry.file_size();
  }
  EXPECT_EQ(files.bytes(), on_disk);
}

std::string error_of(const RecordingOptions& options) {
  try {
    RecordingFiles files(options);
    files.maintain({});
  } catch (const capture::CaptureError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST_F(Files, ADirectoryThatCannotBeMadeIsAnError) {
  test::TemporaryDirectory other;
  RecordingOptions wrong;
  wrong.directory = "/proc/self/status/rec";
  EXPECT_THAT(error_of(wrong), HasSubstr("/proc/self/status/rec: cannot make this directory"));
}

TEST_F(Files, ANearlyFullDiskIsAnErrorOfWritingAndNotOfStarting) {
  RecordingOptions greedy = options();
  greedy.least_free_bytes = std::uint64_t{1} << 62U;
  RecordingFiles files(greedy);
  EXPECT_THROW(files.maintain(now_), capture::CaptureError);
}

}  // namespace
}  // namespace convexcut::recorder
