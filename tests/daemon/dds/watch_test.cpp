// SPDX-License-Identifier: Apache-2.0
//
// `convexcut watch` against publishers of this process. Does not prove that it keeps up with a
// whole stream, nor what a terminal shows.
#include "replay/watch.hpp"

#include <array>
#include <csignal>
#include <future>
#include <memory>
#include <string>
#include <thread>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/dds/health_publisher.hpp"
#include "daemon/dds/publisher.hpp"
#include "support/test_domain.hpp"
#include "support/test_reader.hpp"
#include "tests/daemon/health/made_up_snapshot.hpp"

namespace convexcut::replay {
namespace {

using daemon::testing::made_up_scan;
using daemon::testing::test_settings;
using ::testing::HasSubstr;
using ::testing::Not;

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File temporary_file() { return {std::tmpfile(), &std::fclose}; }

std::string content(std::FILE* file) {
  std::rewind(file);
  std::string text;
  std::array<char, 4096> buffer;
  std::size_t got = 0;
  while ((got = std::fread(buffer.data(), 1, buffer.size(), file)) > 0) {
    text.append(buffer.data(), got);
  }
  return text;
}

WatchOptions options_for(std::chrono::seconds duration) {
  WatchOptions options;
  options.dds = test_settings();
  options.duration = duration;
  return options;
}

// All topics of a daemon.
struct Daemon {
  daemon::Participant participant{test_settings()};
  daemon::ScanPublisher scans{participant, test_settings()};
  daemon::ImuPublisher imu{participant, test_settings()};
  daemon::StatusPublisher status{participant, test_settings()};
  daemon::HealthPublisher health{participant, test_settings()};

  // Returns when the last of watch's readers, status, has matched.
  void wait_for_watch() const {
    const dds_entity_t writer = status.status().handle();
    const daemon::Entity waitset =
        daemon::require(dds_create_waitset(participant.handle()), "waitset");
    dds_set_status_mask(writer, DDS_PUBLICATION_MATCHED_STATUS);
    dds_waitset_attach(waitset.get(), writer, 0);
    while (!status.status().has_reader()) {
      dds_attach_t triggered;
      ASSERT_GT(dds_waitset_wait(waitset.get(), &triggered, 1, DDS_SECS(20)), 0);
    }
  }

  void publish_a_scan() {
    const LevelledScan scan = made_up_scan(30);
    EXPECT_EQ(scans.publish_structure(scan), daemon::PublishStatus::sent);
    EXPECT_EQ(scans.publish_points(scan), daemon::PublishStatus::sent);
    EXPECT_EQ(imu.publish(ImuSample{}, scan.stamp), daemon::PublishStatus::sent);
    daemon::ScanStatus message;
    message.points = 30;
    message.structure_points = 10;
    message.latency = std::chrono::milliseconds{10};
    EXPECT_EQ(status.publish(message), daemon::PublishStatus::sent);
    health.publish(daemon::testing::made_up_snapshot());
  }
};

// Ends watch by Ctrl-C as soon as what it is to see was published. SIGINT is blocked in this thread
// and in those of DDS, so that only watch takes it.
class WatchTest : public ::testing::Test {
 protected:
  void SetUp() override {
    sigset_t interrupt;
    ::sigemptyset(&interrupt);
    ::sigaddset(&interrupt, SIGINT);
    ::pthread_sigmask(SIG_BLOCK, &interrupt, &before_);
  }
  void TearDown() override { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

  // The exit status of a watch over one published scan.
  int watch_a_scan(const WatchOptions& options) {
    Daemon daemon;
    auto result = std::async(std::launch::async, [&] { return watch(options, out_.get()); });
    daemon.wait_for_watch();
    daemon.publish_a_scan();
    ::kill(::getpid(), SIGINT);
    return result.get();
  }

  File out_ = temporary_file();

 private:
  sigset_t before_{};
};

TEST_F(WatchTest, PrintsWhatArrivedAndEndsWithZeroOnCtrlC) {
  EXPECT_EQ(watch_a_scan(options_for(std::chrono::hours{1})), 0);
  const std::string text = content(out_.get());
  EXPECT_THAT(text, HasSubstr("latency"));
  EXPECT_THAT(text, HasSubstr("|     30    33.3    0.0 |   10.00   10.00      0 |"));
  EXPECT_THAT(text, HasSubstr("faulty: imu absent; results late"));
  EXPECT_THAT(text,
              HasSubstr("latency                900    10.000    10.400    11.000    12.000"));
}

TEST_F(WatchTest, PrintsJsonWhenAsked) {
  WatchOptions options = options_for(std::chrono::hours{1});
  options.json = true;
  EXPECT_EQ(watch_a_scan(options), 0);
  const std::string text = content(out_.get());
  EXPECT_THAT(text, HasSubstr("{\"publishers\": 5,"));
  EXPECT_THAT(text, HasSubstr("\"structure_share\": 0.3333,"));
  EXPECT_THAT(text, HasSubstr("\"health\": {\"state\": \"faulty\","));
}

TEST_F(WatchTest, WithoutADaemonSaysWhatToCheckAndEndsWithOne) {
  WatchOptions options = options_for(std::chrono::seconds{1});
  options.patience = std::chrono::seconds{0};
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(watch(options, out_.get()), 1);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(),
              HasSubstr("no convexcut on DDS domain " + std::to_string(options.dds.domain)));
  EXPECT_EQ(content(out_.get()), "");
}

// Waits until the file holds the text; false after a long while.
bool holds(std::FILE* file, const std::string& text) {
  for (int i = 0; i < 400; ++i) {
    std::array<char, 65536> buffer{};
    const ssize_t got = ::pread(::fileno(file), buffer.data(), buffer.size(), 0);
    if (std::string(buffer.data(), static_cast<std::size_t>(got)).find(text) != std::string::npos) {
      return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
  }
  return false;
}

TEST_F(WatchTest, SaysThatADaemonItHasSeenWentAwayAndThatItIsBack) {
  const WatchOptions options = options_for(std::chrono::hours{1});
  const File errors = temporary_file();
  const int stderr_before = ::dup(STDERR_FILENO);
  ::dup2(::fileno(errors.get()), STDERR_FILENO);
  auto daemon = std::make_unique<Daemon>();
  auto result = std::async(std::launch::async, [&] { return watch(options, out_.get()); });
  daemon->wait_for_watch();
  daemon->publish_a_scan();
  EXPECT_TRUE(holds(out_.get(), "faulty: imu absent"));
  daemon.reset();
  const std::string name = "convexcut on DDS domain " + std::to_string(options.dds.domain);
  EXPECT_TRUE(holds(errors.get(), name + " went away: the daemon ended"));
  daemon = std::make_unique<Daemon>();
  EXPECT_TRUE(holds(errors.get(), name + " is back"));
  ::kill(::getpid(), SIGINT);
  EXPECT_EQ(result.get(), 0);
  ::dup2(stderr_before, STDERR_FILENO);
  ::close(stderr_before);
  EXPECT_THAT(content(errors.get()), Not(HasSubstr("no convexcut")));
}

TEST_F(WatchTest, NamesTheQosThatAPublisherDoesNotOffer) {
  const daemon::Participant participant(test_settings());
  const daemon::Entity topic =
      daemon::require(dds_create_topic(participant.handle(), daemon::kImuType.descriptor,
                                       "rt/imu/data", nullptr, nullptr),
                      "topic");
  const daemon::Qos qos(dds_create_qos());
  const dds_data_representation_id_t newer = DDS_DATA_REPRESENTATION_XCDR2;
  dds_qset_data_representation(qos.get(), 1, &newer);
  const daemon::Entity writer = daemon::require(
      dds_create_writer(participant.handle(), topic.get(), qos.get(), nullptr), "writer");
  WatchOptions options = options_for(std::chrono::seconds{1});
  options.patience = std::chrono::seconds{0};
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(watch(options, out_.get()), 1);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(),
              HasSubstr("rt/imu/data has a publisher with incompatible QoS: DATA_REPRESENTATION"));
}

TEST_F(WatchTest, RefusesATopicNameThatRos2CannotNameBeforeItListens) {
  WatchOptions options = options_for(std::chrono::seconds{1});
  options.dds.imu_topic = "imu data";
  EXPECT_THROW(watch(options, stdout), daemon::DdsError);
}

}  // namespace
}  // namespace convexcut::replay
