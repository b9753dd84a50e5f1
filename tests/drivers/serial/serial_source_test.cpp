// SPDX-License-Identifier: Apache-2.0
//
// A serial line made of a pseudo-terminal. Does not prove anything about bits on a wire, nor about
// the latency of USB adapters.
#include "drivers/serial/serial_source.hpp"

#include <cerrno>
#include <fstream>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "drivers/live/host_clock.hpp"
#include "replay/emulator/pseudo_terminal.hpp"
#include "tests/drivers/xsens/frames.hpp"
#include "tests/drivers/xsens/recording_sink.hpp"
#include "tests/support/in_child.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::serial {
namespace {

using convexcut::test::RecordingSink;
using convexcut::test::TemporaryDirectory;
using replay::PseudoTerminal;
using xsens::test::ByteVector;
using xsens::test::hex;

class CollectingTap final : public live::RawTap {
 public:
  void on_record(const capture::Record& record) noexcept override {
    kinds.push_back(record.kind);
    stamps.push_back(record.stamp);
    bytes.insert(bytes.end(), record.payload.begin(), record.payload.end());
  }
  std::vector<capture::RecordKind> kinds;
  std::vector<HostTime> stamps;
  ByteVector bytes;
};

class SerialTest : public ::testing::Test {
 protected:
  void plug_in() { terminal_ = std::make_unique<PseudoTerminal>(device()); }
  void unplug() { terminal_.reset(); }
  [[nodiscard]] std::filesystem::path device() const { return directory_.path() / "imu"; }

  bool receive_until(const std::function<bool()>& done) {
    const auto give_up = live::Steady::now() + std::chrono::seconds{20};
    while (!done()) {
      if (live::Steady::now() > give_up) return false;
      source_.receive(std::chrono::milliseconds{10});
    }
    return true;
  }
  bool link_becomes(live::LinkState state) {
    return receive_until([&] { return source_.link() == state; });
  }
  bool receive_samples(std::size_t count) {
    return receive_until([&] { return sink_.samples.size() >= count; });
  }
  void send(const ByteVector& bytes) { ASSERT_EQ(terminal_->send(bytes), bytes.size()); }

  TemporaryDirectory directory_;
  std::unique_ptr<PseudoTerminal> terminal_;
  RecordingSink sink_;
  CollectingTap tap_;
  xsens::ImuDriver driver_{{.baud = 460800}, sink_};
  SerialSource source_{{.device = device(), .baud = 460800}, driver_, &tap_};
};

TEST_F(SerialTest, MessageBecomesASampleStampedWhenItWasRead) {
  plug_in();
  ASSERT_TRUE(link_becomes(live::LinkState::open));
  const ByteVector message = hex(xsens::test::kQuaternionMessage);
  const HostTime before = live::host_now();
  send(message);
  ASSERT_TRUE(receive_samples(1));
  const Duration line = xsens::line_time(message.size(), 460800);
  EXPECT_GE(sink_.samples[0].arrival + line, before);
  EXPECT_LE(sink_.samples[0].arrival + line, live::host_now());
}

TEST_F(SerialTest, LineIsRawAtTheConfiguredRate) {
  plug_in();
  ASSERT_TRUE(link_becomes(live::LinkState::open));
  EXPECT_EQ(terminal_->baud(), 460800U);
  // Every byte value, among them those that a terminal treats in a special way, comes through, and
  // nothing is echoed.
  ByteVector all;
  for (int value = 0; value < 256; ++value) all.push_back(static_cast<std::byte>(value));
  send(all);
  ASSERT_TRUE(receive_until([&] { return tap_.bytes.size() >= all.size(); }));
  EXPECT_EQ(tap_.bytes, all);
  EXPECT_TRUE(terminal_->receive().empty());
}

TEST_F(SerialTest, MessageInPiecesIsOneSample) {
  plug_in();
  ASSERT_TRUE(link_becomes(live::LinkState::open));
  const ByteVector message = hex(xsens::test::kImuSetMessage);
  for (const std::byte b : message) {
    EXPECT_TRUE(sink_.samples.empty());
    send({b});
    source_.receive(std::chrono::seconds{10});
  }
  EXPECT_EQ(sink_.samples.size(), 1U);
  EXPECT_EQ(source_.counters().bytes.value(), message.size());
  EXPECT_EQ(source_.counters().reads.value(), message.size());
}

TEST_F(SerialTest, TapHearsEveryRead) {
  plug_in();
  ASSERT_TRUE(link_becomes(live::LinkState::open));
  const ByteVector message = hex(xsens::test::kImuSetMessage);
  send(message);
  ASSERT_TRUE(receive_samples(1));
  EXPECT_EQ(tap_.bytes, message);
  EXPECT_EQ(tap_.kinds.front(), capture::RecordKind::serial);
  EXPECT_EQ(tap_.stamps.back(),
            sink_.samples[0].arrival + xsens::line_time(message.size(), 460800));
}

TEST_F(SerialTest, GarbageIsCountedAndTheNextMessageFound) {
  plug_in();
  ASSERT_TRUE(link_becomes(live::LinkState::open));
  send(ByteVector(700, std::byte{0xA5}));
  send(hex(xsens::test::kQuaternionMessage));
  ASSERT_TRUE(receive_samples(1));
  EXPECT_EQ(driver_.counters().xbus.skipped_bytes.value(), 700U);
}

TEST_F(SerialTest, AbsentDeviceIsTheErrorOfTheLinkUntilItIsPluggedIn) {
  source_.receive(Duration{0});
  EXPECT_EQ(source_.link(), live::LinkState::closed);
  EXPECT_EQ(source_.last_error(), ENOENT);
  plug_in();
  ASSERT_TRUE(link_becomes(live::LinkState::open));
  EXPECT_EQ(source_.last_error(), 0);
}

TEST_F(SerialTest, UnpluggedDeviceIsOpenedAgainWhenItIsBack) {
  plug_in();
  ASSERT_TRUE(link_becomes(live::LinkState::open));
  for (std::size_t times = 1; times <= 2; ++times) {
    send(hex(xsens::test::kQuaternionMessage));
    ASSERT_TRUE(receive_samples(times));
    unplug();
    ASSERT_TRUE(link_becomes(live::LinkState::closed));
    EXPECT_EQ(source_.last_error(), EIO);
    EXPECT_EQ(source_.counters().unplugged.value(), times);
    plug_in();
    ASSERT_TRUE(link_becomes(live::LinkState::open));
  }
  EXPECT_EQ(source_.counters().opened.value(), 3U);
}

TEST_F(SerialTest, BytesFromBeforeTheOpeningAreDropped) {
  plug_in();
  {
    SerialPort earlier;
    ASSERT_EQ(earlier.open(device(), 115200), 0);
    send(hex(xsens::test::kQuaternionMessage));
  }
  ASSERT_TRUE(link_becomes(live::LinkState::open));
  send(hex(xsens::test::kImuSetMessage));
  ASSERT_TRUE(receive_samples(1));
  EXPECT_EQ(sink_.samples[0].counter, 36240);
  EXPECT_EQ(sink_.samples.size(), 1U);
}

TEST_F(SerialTest, DeviceOfAnotherProgramIsBusyUntilThatCloses) {
  plug_in();
  {
    SerialPort other;
    ASSERT_EQ(other.open(device(), 115200), 0);
    source_.receive(Duration{0});
    EXPECT_EQ(source_.last_error(), EBUSY);
    EXPECT_EQ(terminal_->baud(), 115200U);  // and is left alone
  }
  EXPECT_TRUE(link_becomes(live::LinkState::open));
}

TEST_F(SerialTest, FileThatIsNoTerminalIsTheErrorOfTheLink) {
  std::ofstream(device()) << "text";
  source_.receive(Duration{0});
  EXPECT_EQ(source_.link(), live::LinkState::closed);
  EXPECT_EQ(source_.last_error(), ENOTTY);
}

TEST(SerialPort, EveryRateOfTheListIsSet) {
  const PseudoTerminal terminal;
  SerialPort port;
  ASSERT_EQ(port.open(terminal.path(), 0), 0);
  for (const std::uint32_t baud : supported_bauds()) {
    ASSERT_EQ(port.set_baud(baud), 0) << baud;
    EXPECT_EQ(terminal.baud(), baud);
  }
  EXPECT_EQ(port.set_baud(76800), EINVAL);
}

TEST(SerialPort, LineThatWasClosedIsFreeAlsoForThoseWithoutPrivileges) {
  convexcut::test::without_privileges([] {
    const PseudoTerminal terminal;
    for (int i = 0; i < 2; ++i) {
      SerialPort port;
      EXPECT_EQ(port.open(terminal.path(), 115200), 0);
    }
  });
}

TEST(SerialPort, RateThatTermiosDoesNotHaveIsRefused) {
  const PseudoTerminal terminal;
  SerialPort port;
  EXPECT_EQ(port.open(terminal.path(), 14400), EINVAL);
  EXPECT_FALSE(port.is_open());
}

}  // namespace
}  // namespace convexcut::serial
