// SPDX-License-Identifier: Apache-2.0
//
// Live sources as a configuration asks for them. Does not prove that bytes arrive on real devices.
#include "daemon/sources/live_sources.hpp"

#include <functional>

#include <gmock/gmock.h>

#include "config/loader.hpp"
#include "drivers/live/host_clock.hpp"
#include "replay/emulator/emulated_imu.hpp"
#include "tests/drivers/velodyne/collecting_sink.hpp"
#include "tests/drivers/velodyne/packets.hpp"
#include "tests/drivers/xsens/frames.hpp"
#include "tests/drivers/xsens/recording_sink.hpp"
#include "tests/support/in_child.hpp"
#include "tests/support/udp_sender.hpp"

namespace convexcut::daemon {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

struct Sinks {
  velodyne::test::CollectingSink returns;
  test::RecordingSink samples;
  NullSink<EncoderSample> angles;
};

config::Config usual() {
  config::Config config;
  config.lidar.model = config::LidarModel::hdl32e;
  config.lidar.data_port = test::free_udp_port();
  config.lidar.position_port = test::free_udp_port();
  config.mount.orientation = config::MountOrientation::fixed;
  return config;
}

bool receive_until(const LiveSources& live, const std::function<bool()>& done) {
  const auto give_up = live::Steady::now() + std::chrono::seconds{20};
  while (!done()) {
    if (live::Steady::now() > give_up) return false;
    for (const LiveSources::Entry& entry : live.entries()) {
      entry.source.receive(std::chrono::milliseconds{1});
    }
  }
  return true;
}

TEST(LiveSources, FixedMountNeedsTheLidarOnly) {
  Sinks sinks;
  const config::Config config = usual();
  const LiveSources live(config, sinks.returns, sinks.samples, sinks.angles);
  ASSERT_EQ(live.entries().size(), 1U);
  EXPECT_EQ(live.entries()[0].name, "lidar");
  EXPECT_EQ(live.entries()[0].role, SourceRole::lidar);
  EXPECT_EQ(live.entries()[0].device, "UDP ports " + std::to_string(config.lidar.data_port) +
                                          " and " + std::to_string(config.lidar.position_port));
  EXPECT_EQ(live.imu(), nullptr);
}

TEST(LiveSources, OrientationWithoutAnImuIsAConfigurationError) {
  Sinks sinks;
  config::Config config = usual();
  config.mount.orientation = config::MountOrientation::imu;
  EXPECT_THROW(LiveSources(config, sinks.returns, sinks.samples, sinks.angles),
               config::ConfigError);
}

TEST(LiveSources, RateThatNoLineHasIsAConfigurationError) {
  Sinks sinks;
  config::Config config = usual();
  config.imu.device = "/dev/none";
  config.imu.baud = 14400;
  try {
    const LiveSources live(config, sinks.returns, sinks.samples, sinks.angles);
    FAIL() << "no error";
  } catch (const config::ConfigError& error) {
    EXPECT_THAT(error.what(), StartsWith("imu.baud: expected 0 or one of 4800, "));
    EXPECT_THAT(error.what(), HasSubstr("found 14400"));
  }
}

TEST(LiveSources, BothSourcesReachTheirSinks) {
  Sinks sinks;
  replay::PseudoTerminal imu;
  config::Config config = usual();
  config.imu.device = imu.path();
  LiveSources live(config, sinks.returns, sinks.samples, sinks.angles);
  ASSERT_TRUE(receive_until(live, [&] {
    return live.lidar().link() == live::LinkState::open &&
           live.imu()->link() == live::LinkState::open;
  }));
  test::UdpSender().send("127.0.0.1", config.lidar.data_port, velodyne::test::DataPacket().bytes());
  const auto message = test::hex(xsens::test::kQuaternionMessage);
  ASSERT_EQ(imu.send(message), message.size());
  EXPECT_TRUE(receive_until(live, [&] {
    return sinks.returns.batches.size() == 1 && sinks.samples.samples.size() == 1;
  }));
  EXPECT_EQ(live.lidar_driver().counters().data_packets.value(), 1U);
  EXPECT_EQ(live.imu_driver()->counters().samples.value(), 1U);
  EXPECT_THAT(live.warnings(), IsEmpty());
}

TEST(LiveSources, AbsentDeviceIsAWarningThatNamesIt) {
  Sinks sinks;
  config::Config config = usual();
  config.imu.device = "/dev/serial/by-id/none";
  LiveSources live(config, sinks.returns, sinks.samples, sinks.angles);
  EXPECT_THAT(live.warnings(), IsEmpty());  // nothing was tried yet
  ASSERT_TRUE(receive_until(live, [&] { return live.lidar().link() == live::LinkState::open; }));
  EXPECT_THAT(live.warnings(),
              ElementsAre("imu: /dev/serial/by-id/none: No such file or directory; it is tried "
                          "again"));
}

TEST(LiveSources, ImuThatRefusesIsWarnedOf) {
  Sinks sinks;
  replay::EmulatedImu imu({}, {.refuse_with = 33});
  config::Config config = usual();
  config.imu.device = imu.terminal().path();
  config.imu.configure = true;
  LiveSources live(config, sinks.returns, sinks.samples, sinks.angles);
  const auto message = test::hex(xsens::test::kQuaternionMessage);
  ASSERT_TRUE(receive_until(live, [&] {
    imu.answer();
    imu.measure(message);
    return live.imu()->configuration()->state() == xsens::MtState::measuring;
  }));
  EXPECT_THAT(live.warnings(),
              ElementsAre("imu: " + config.imu.device +
                          ": refuses to send what is wanted: invalid parameter; it sends what it "
                          "was set to before"));
}

TEST(LiveSources, ImuThatDoesNotAnswerIsWarnedOf) {
  Sinks sinks;
  replay::EmulatedImu imu({}, {.deaf_to = 1'000'000});
  config::Config config = usual();
  config.imu.device = imu.terminal().path();
  config.imu.configure = true;
  LiveSources live(config, sinks.returns, sinks.samples, sinks.angles);
  ASSERT_TRUE(receive_until(live, [&] {
    imu.answer();
    return live.imu()->configuration()->state() == xsens::MtState::no_answer;
  }));
  EXPECT_THAT(live.warnings(), ElementsAre(HasSubstr("does not answer at ")));
}

TEST(LiveSources, BusIsASourceOfOrientation) {
  Sinks sinks;
  config::Config config = usual();
  config.mount.orientation = config::MountOrientation::imu;
  config.can.interface = "no-such-can";
  LiveSources live(config, sinks.returns, sinks.samples, sinks.angles);
  ASSERT_EQ(live.entries().size(), 2U);
  EXPECT_EQ(live.entries()[1].name, "can");
  EXPECT_EQ(live.entries()[1].role, SourceRole::imu);
  EXPECT_EQ(live.entries()[1].device, "no-such-can");
  EXPECT_EQ(live.bus()->encoder(), nullptr);
  ASSERT_TRUE(receive_until(live, [&] { return live.can()->last_error() != 0; }));
  EXPECT_THAT(live.warnings(), Contains(StartsWith("can: no-such-can: ")));
}

TEST(LiveSources, EncoderIsOnTheBus) {
  Sinks sinks;
  config::Config config = usual();
  config.encoder.use = config::EncoderUse::orientation;
  EXPECT_THROW(LiveSources(config, sinks.returns, sinks.samples, sinks.angles),
               config::ConfigError);
  config.can.interface = "no-such-can";
  const LiveSources live(config, sinks.returns, sinks.samples, sinks.angles);
  EXPECT_NE(live.bus()->encoder(), nullptr);
}

TEST(LiveSources, CutReceiveBufferIsAWarningThatSaysWhatToDo) {
  test::without_privileges([] {
    Sinks sinks;
    config::Config config = usual();
    config.lidar.receive_buffer_kib = 1'048'576;
    LiveSources live(config, sinks.returns, sinks.samples, sinks.angles);
    ASSERT_TRUE(receive_until(live, [&] { return live.lidar().link() == live::LinkState::open; }));
    ASSERT_LT(live.lidar().receive_buffer_bytes(), std::size_t{1'048'576} * 1024);
    EXPECT_THAT(live.warnings(), ElementsAre(HasSubstr("net.core.rmem_max=1073741824")));
  });
}

}  // namespace
}  // namespace convexcut::daemon
