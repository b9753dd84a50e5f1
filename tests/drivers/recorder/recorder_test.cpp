// SPDX-License-Identifier: Apache-2.0
//
// The recorder with its thread, on real files; a full disk is a limit on the size of files. Does
// not prove that the receive threads are never slowed down by a copy.
#include "drivers/recorder/recorder.hpp"

#include <csignal>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/drivers/recorder/records.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::recorder {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;
using ::testing::SizeIs;

bool wait_until(const std::function<bool()>& reached) {
  for (int i = 0; i < 2000; ++i) {
    if (reached()) return true;
    std::this_thread::sleep_for(milliseconds{5});
  }
  return false;
}

class RecorderTest : public ::testing::Test {
 protected:
  [[nodiscard]] RecorderOptions options() const {
    RecorderOptions options;
    options.files.directory = folder_.path();
    options.files.least_free_bytes = 0;
    options.retry_after = milliseconds{20};
    return options;
  }
  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return folder_.path() / name;
  }
  Recorder::Say say() {
    return [this](bool problem, const std::string& line) {
      const std::lock_guard lock(mutex_);
      lines_.push_back((problem ? "problem: " : "note: ") + line);
    };
  }
  [[nodiscard]] std::vector<std::string> lines() {
    const std::lock_guard lock(mutex_);
    return lines_;
  }
  void hear_packets(Recorder& recorder, int count) {
    for (int i = 0; i < count; ++i) {
      recorder.tap(Stream::lidar)
          .on_record(testing::datagram(number_, testing::payload_of(number_, 1206)));
      ++number_;
    }
  }

  test::TemporaryDirectory folder_;
  std::uint64_t number_ = 0;

 private:
  std::mutex mutex_;
  std::vector<std::string> lines_;
};

TEST_F(RecorderTest, WritesEverythingThatWasHeardBeforeItEnds) {
  {
    Recorder recorder(options(), say());
    std::thread imu([&recorder] {
      for (std::uint64_t n = 0; n < 300; ++n) {
        recorder.tap(Stream::imu).on_record(testing::read_of(n, testing::payload_of(n, 50)));
      }
    });
    hear_packets(recorder, 2000);
    imu.join();
    EXPECT_EQ(recorder.missing(), 0U);
    EXPECT_TRUE(recorder.is_recording());
  }
  const auto lidar = testing::content_of(path("lidar_000.pcap"));
  EXPECT_EQ(lidar.records, 2000U);
  EXPECT_EQ(lidar.wrong, 0U);
  EXPECT_EQ(lidar.end, capture::ReadStatus::end);
  const auto imu = testing::content_of(path("imu_000.pcap"), 2'500'001);
  EXPECT_EQ(imu.records, 300U);
  EXPECT_EQ(imu.wrong, 0U);
  EXPECT_TRUE(lines().empty());
}

TEST_F(RecorderTest, CountsWhatItWrites) {
  Recorder recorder(options(), say());
  hear_packets(recorder, 10);
  ASSERT_TRUE(wait_until([&] { return recorder.counters().records.value() == 10; }));
  EXPECT_EQ(recorder.counters().bytes.value(), 24 + 10 * (16 + 42 + 1206U));
}

TEST_F(RecorderTest, WhatNoCaptureCanHoldIsCountedAndTheRestGoesOn) {
  Recorder recorder(options(), say());
  const auto payload = testing::payload_of(0, 10);
  capture::Record nowhere = testing::datagram(0, payload);
  nowhere.source.reset();
  recorder.tap(Stream::lidar).on_record(nowhere);
  hear_packets(recorder, 1);
  ASSERT_TRUE(wait_until([&] { return recorder.counters().records.value() == 1; }));
  EXPECT_EQ(recorder.counters().refused.value(), 1U);
  EXPECT_EQ(recorder.missing(), 1U);
}

// Files may not grow beyond a size, as on a full disk, for as long as this lives.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
};

TEST_F(RecorderTest, AFullDiskIsToldOnceCountedAndRecoveredFrom) {
  Recorder recorder(options(), say());
  {
    const FileSizeLimit limit(20'000);
    hear_packets(recorder, 100);
    ASSERT_TRUE(wait_until([&] { return recorder.counters().stops.value() > 0; }));
    EXPECT_THAT(lines(), SizeIs(1));
    EXPECT_THAT(lines().front(), HasSubstr("lidar_000.pcap: cannot write: File too large; "
                                           "recording is stopped"));
    // Tried again, which fails again: nothing more is said.
    const auto stops = recorder.counters().stops.value();
    ASSERT_TRUE(wait_until([&] {
      hear_packets(recorder, 100);
      return recorder.counters().stops.value() > stops;
    }));
    EXPECT_THAT(lines(), SizeIs(1));
  }
  ASSERT_TRUE(wait_until([&] { return lines().size() == 2; }));
  EXPECT_THAT(lines().back(), HasSubstr("note: recording goes on in segment "));
  EXPECT_GT(recorder.missing(), 0U);
  const std::uint64_t written = recorder.counters().records.value();
  hear_packets(recorder, 50);
  EXPECT_TRUE(wait_until([&] { return recorder.counters().records.value() == written + 50; }));
  EXPECT_TRUE(recorder.is_recording());
  // What the first segment could take is still read, up to the record that was cut.
  const auto cut = testing::content_of(path("lidar_000.pcap"));
  EXPECT_GT(cut.records, 10U);
  EXPECT_EQ(cut.wrong, 0U);
  EXPECT_EQ(cut.end, capture::ReadStatus::truncated);
}

TEST_F(RecorderTest, ADirectoryThatGoesAwayAndComesBackIsRecoveredFrom) {
  RecorderOptions inside = options();
  inside.files.directory = path("rec");
  inside.files.max_file_bytes = 1;  // a file a second
  Recorder recorder(inside, say());
  hear_packets(recorder, 1);
  ASSERT_TRUE(wait_until([&] { return recorder.counters().records.value() == 1; }));
  std::filesystem::remove_all(path("rec"));
  ASSERT_TRUE(wait_until([&] { return lines().size() == 1; }));
  EXPECT_THAT(lines().front(), HasSubstr("rec: cannot be recorded to: No such file or directory"));
  std::filesystem::create_directory(path("rec"));
  ASSERT_TRUE(wait_until([&] { return lines().size() == 2; }));
  hear_packets(recorder, 1);
  EXPECT_TRUE(wait_until([&] { return recorder.counters().records.value() == 2; }));
}

// A program that is killed while it records, at a moment of the test's choice.
TEST_F(RecorderTest, WhatWasFlushedBeforeAKillIsReadable) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    Recorder recorder(options(), [](bool, const std::string&) {});
    for (;;) {
      hear_packets(recorder, 20);
      std::this_thread::sleep_for(milliseconds{1});
    }
  }
  const auto enough = [this] {
    std::error_code none;
    const auto size = std::filesystem::file_size(path("lidar_000.pcap"), none);
    return !none && size > 1'000'000;
  };
  EXPECT_TRUE(wait_until(enough));
  ::kill(child, SIGKILL);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  const auto content = testing::content_of(path("lidar_000.pcap"));
  EXPECT_GT(content.records, 700U);
  EXPECT_EQ(content.first, 0U);
  EXPECT_EQ(content.wrong, 0U);
  EXPECT_NE(content.end, capture::ReadStatus::failed);
}

TEST_F(RecorderTest, AWrongDirectoryIsAnErrorAtOnce) {
  RecorderOptions wrong = options();
  wrong.files.directory = "/proc/self/status/rec";
  EXPECT_THROW(Recorder(wrong, say()), capture::CaptureError);
}

}  // namespace
}  // namespace convexcut::recorder
