// SPDX-License-Identifier: Apache-2.0
//
// A serial source and an emulated MTi at the two ends of a pseudo-terminal, whose rate both look
// at. Does not prove that an adapter changes its rate as fast as a terminal does.
#include <functional>
#include <optional>

#include <gtest/gtest.h>

#include "drivers/live/host_clock.hpp"
#include "drivers/serial/serial_source.hpp"
#include "replay/emulator/emulated_imu.hpp"
#include "tests/drivers/xsens/frames.hpp"
#include "tests/drivers/xsens/recording_sink.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::serial {
namespace {

using replay::EmulatedImu;
using replay::MtiOptions;
using xsens::MtState;
using xsens::test::hex;

class ConfiguredSerial : public ::testing::Test {
 protected:
  void start(std::optional<xsens::MtConfigurationOptions> configuration, MtiOptions device) {
    imu_.emplace(directory_.path() / "imu", std::move(device));
    source_.emplace(
        SerialSourceOptions{.device = directory_.path() / "imu", .configuration = configuration},
        driver_);
  }
  bool run_until(const std::function<bool()>& done) {
    const auto give_up = live::Steady::now() + std::chrono::seconds{30};
    while (!done()) {
      if (live::Steady::now() > give_up) return false;
      imu_->answer();
      imu_->measure(hex(xsens::test::kImuSetMessage));
      source_->receive(std::chrono::milliseconds{1});
    }
    return true;
  }
  bool becomes(MtState state) {
    return run_until([&] { return source_->configuration()->state() == state; });
  }
  bool more_samples() {
    const std::size_t before = sink_.samples.size();
    return run_until([&] { return sink_.samples.size() > before; });
  }

  convexcut::test::TemporaryDirectory directory_;
  convexcut::test::RecordingSink sink_;
  xsens::ImuDriver driver_{{.baud = 115200}, sink_};
  std::optional<EmulatedImu> imu_;
  std::optional<SerialSource> source_;
};

constexpr xsens::MtConfigurationOptions kFaster{.baud = 115200, .set_baud = 460800};

TEST_F(ConfiguredSerial, PassiveSourceSendsNothing) {
  start(std::nullopt, {});
  ASSERT_TRUE(more_samples());
  EXPECT_EQ(source_->configuration(), nullptr);
  EXPECT_EQ(imu_->device().messages(), 0U);
}

TEST_F(ConfiguredSerial, WrongRateIsGarbage) {
  start(std::nullopt, {.baud = 921600});
  ASSERT_TRUE(run_until([&] { return driver_.counters().xbus.skipped_bytes.value() > 500; }));
  EXPECT_TRUE(sink_.samples.empty());
}

TEST_F(ConfiguredSerial, DeviceAndLineAreSetAndSamplesCome) {
  start(kFaster, {});
  ASSERT_TRUE(becomes(MtState::measuring));
  EXPECT_EQ(imu_->terminal().baud(), 460800U);
  EXPECT_EQ(imu_->device().baud(), 460800U);
  EXPECT_EQ(imu_->device().outputs().size(), 6U);
  EXPECT_FALSE(source_->configuration()->identity().empty());
  sink_.samples.clear();
  const HostTime before = live::host_now();
  ASSERT_TRUE(more_samples());
  // The line's time is that of the new rate: not 10 ms and more. The newest sample: others may have
  // waited on the terminal and come in the same read.
  const Duration line = xsens::line_time(hex(xsens::test::kImuSetMessage).size(), 460800);
  EXPECT_GE(sink_.samples.back().arrival + line, before);
}

TEST_F(ConfiguredSerial, DeviceIsSearchedForAtAllRates) {
  start(xsens::MtConfigurationOptions{.baud = 115200, .scan_baud = true}, {.baud = 230400});
  ASSERT_TRUE(becomes(MtState::measuring));
  EXPECT_EQ(source_->configuration()->baud(), 230400U);
  EXPECT_TRUE(more_samples());
}

TEST_F(ConfiguredSerial, DeviceThatWasPluggedInAgainIsConfiguredAnewAtTheRateItHas) {
  start(kFaster, {});
  ASSERT_TRUE(becomes(MtState::measuring));
  imu_->unplug();
  ASSERT_TRUE(becomes(MtState::off));
  EXPECT_EQ(source_->link(), live::LinkState::closed);
  imu_->plug_in();
  ASSERT_TRUE(becomes(MtState::measuring));
  EXPECT_EQ(source_->configuration()->counters().completed.value(), 2U);
  EXPECT_EQ(imu_->terminal().baud(), 460800U);
  EXPECT_TRUE(more_samples());
}

TEST_F(ConfiguredSerial, DeviceThatIsDisturbedIsConfiguredAllTheSame) {
  start(kFaster, {.deaf_to = 2});
  ASSERT_TRUE(run_until([&] {
    imu_->disturb(xsens::test::ByteVector(7, std::byte{0xFA}));
    return source_->configuration()->state() == MtState::measuring;
  }));
  EXPECT_TRUE(more_samples());
  EXPECT_GT(driver_.counters().xbus.skipped_bytes.value(), 0U);
}

}  // namespace
}  // namespace convexcut::serial
