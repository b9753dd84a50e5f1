// SPDX-License-Identifier: Apache-2.0
//
// The dialogue with an emulated device in emulated time. Does not prove that a real MTi answers as
// the documents say, nor when it takes a new bit rate, which they leave open.
#include "drivers/xsens/mt_configuration.hpp"

#include <deque>

#include <gtest/gtest.h>

#include "drivers/xsens/baud_code.hpp"
#include "replay/emulator/mti_emulator.hpp"
#include "tests/drivers/xsens/frames.hpp"

namespace convexcut::xsens {
namespace {

using replay::MtiEmulator;
using replay::MtiOptions;
using replay::MtiOutput;
using replay::MtiReply;
using std::chrono::milliseconds;
using std::chrono::seconds;
using test::ByteVector;
using test::hex;
using Time = MtConfiguration::Time;

// A line with the device at its other end. What the device says takes `latency` to arrive; where
// both ends have different rates nothing arrives.
class Dialogue final : private MtLine {
 public:
  explicit Dialogue(const MtConfigurationOptions& options = {}, MtiOptions device = {})
      : device_(std::move(device)), baud_(options.baud), configuration(options, *this) {}

  void open() { configuration.begin(now_); }

  // Lets time pass in steps of 10 ms; the device measures in each.
  void pass(Duration span) {
    for (const Time end = now_ + span; now_ < end;) step();
  }
  // False when it does not become so within a minute.
  bool becomes(MtState state) {
    for (const Time end = now_ + std::chrono::minutes{1}; now_ < end;) {
      if (configuration.state() == state) return true;
      step();
    }
    return false;
  }

  [[nodiscard]] Time now() const { return now_; }
  [[nodiscard]] const MtiEmulator& device() const { return device_; }
  // Of the requests that went out, by message.
  [[nodiscard]] long sent(MessageId message) const {
    return std::count(sent_.begin(), sent_.end(), static_cast<std::uint8_t>(message));
  }
  void deliver(const ByteVector& bytes) {
    framer_.feed(bytes, [this](const XbusFrame& frame) { configuration.on_frame(frame); });
  }

  Duration latency = milliseconds{5};
  bool connected = true;  // to the host's ears
  bool measures = true;
  std::uint32_t fastest = 4'000'000;  // rate that the host's end has

 private:
  struct Coming {
    Time due;
    MtiReply reply;
  };

  void send(wire::Bytes frame) noexcept override {
    sent_.push_back(wire::load_u8(frame, kMessageIdOffset));
    if (baud_ != 0 && baud_ != device_.baud()) return;
    for (MtiReply& reply : device_.on_bytes(frame)) {
      coming_.push_back({now_ + latency, std::move(reply)});
    }
  }
  bool set_baud(std::uint32_t baud) noexcept override {
    baud_ = baud;
    return baud <= fastest;
  }

  void step() {
    now_ += milliseconds{10};
    configuration.update(now_);
    if (device_.measuring() && measures) hear(device_.baud(), hex(test::kQuaternionMessage));
    while (!coming_.empty() && coming_.front().due <= now_) {
      const MtiReply reply = std::move(coming_.front().reply);
      coming_.pop_front();
      hear(reply.baud, reply.bytes);
    }
  }
  void hear(std::uint32_t baud, const ByteVector& bytes) {
    if (connected && (baud_ == 0 || baud == baud_)) deliver(bytes);
  }

  MtiEmulator device_;
  std::uint32_t baud_;
  Time now_{seconds{1000}};
  std::deque<Coming> coming_;
  std::vector<std::uint8_t> sent_;
  XbusCounters counters_;
  XbusFramer framer_{counters_};

 public:
  MtConfiguration configuration;
};

std::vector<MtiOutput> outputs(std::uint16_t rate) {
  return {{0x1020, 0xFFFF}, {0x1060, 0xFFFF}, {0x2010, rate},
          {0x4020, rate},   {0x8020, rate},   {0xE020, 0xFFFF}};
}

constexpr MtConfigurationOptions kUsb{.baud = 0};
constexpr MtConfigurationOptions kFaster{.baud = 115200, .set_baud = 460800};

TEST(MtOutputs, ListIsTheOneOfTheDocuments) {
  const auto list = mt_output_list(400);
  EXPECT_EQ(ByteVector(list.begin(), list.end()),
            test::payload_of(hex(test::kSetOutputConfiguration)));
  EXPECT_EQ(mt_message_size(), 73U);
}

TEST(MtOutputs, RateIsOneThatTheDeviceHasAndTheLineCarries) {
  EXPECT_EQ(mt_rate_for(400, 460800), 400);
  EXPECT_EQ(mt_rate_for(400, 0), 400);
  EXPECT_EQ(mt_rate_for(400, 115200), 100);  // 157 is what the line carries
  EXPECT_EQ(mt_rate_for(400, 292'000), 400);
  EXPECT_EQ(mt_rate_for(400, 291'999), 200);
  EXPECT_EQ(mt_rate_for(400, 1), 1);
}

TEST(MtConfiguration, DeviceIsSetToSendWhatIsWanted) {
  Dialogue rig(kUsb);
  rig.open();
  ASSERT_TRUE(rig.becomes(MtState::measuring));
  EXPECT_EQ(rig.device().outputs(), outputs(400));
  EXPECT_TRUE(rig.device().measuring());
  EXPECT_EQ(rig.configuration.outcome(), MtOutcome::as_wanted);
  EXPECT_EQ(rig.configuration.identity(), "MTi-30-2A5G4, firmware 1.8.2, 03800030");
  EXPECT_EQ(rig.configuration.counters().completed.value(), 1U);
  EXPECT_EQ(rig.configuration.counters().timeouts.value(), 0U);
}

TEST(MtConfiguration, DeviceThatIsAsWantedIsNotWrittenTo) {
  Dialogue rig(kUsb);
  rig.open();
  ASSERT_TRUE(rig.becomes(MtState::measuring));
  rig.configuration.end();
  EXPECT_EQ(rig.sent(MessageId::set_output_configuration), 2);  // a question and an order
  rig.open();
  ASSERT_TRUE(rig.becomes(MtState::measuring));
  EXPECT_EQ(rig.sent(MessageId::set_output_configuration), 3);
}

TEST(MtConfiguration, DeviceThatWasLeftInConfigurationMeasuresAgain) {
  Dialogue rig(kUsb, {.measuring = false});
  rig.open();
  EXPECT_TRUE(rig.becomes(MtState::measuring));
  EXPECT_TRUE(rig.device().measuring());
}

TEST(MtConfiguration, WhatIsNotAnsweredIsAskedAgain) {
  for (std::size_t deaf = 1; deaf <= 3; ++deaf) {
    Dialogue rig(kUsb, {.deaf_to = deaf});
    rig.open();
    ASSERT_TRUE(rig.becomes(MtState::measuring)) << deaf;
    EXPECT_EQ(rig.configuration.counters().timeouts.value(), deaf);
    EXPECT_EQ(rig.configuration.counters().dialogues.value(), 1U);
  }
}

TEST(MtConfiguration, AnswersThatComeTooLateDoNotConfuse) {
  Dialogue rig(kUsb);
  rig.latency = milliseconds{400};  // each after the question was repeated
  rig.open();
  ASSERT_TRUE(rig.becomes(MtState::measuring));
  EXPECT_EQ(rig.device().outputs(), outputs(400));
  rig.pass(seconds{5});
  EXPECT_EQ(rig.configuration.state(), MtState::measuring);
  EXPECT_EQ(rig.configuration.outcome(), MtOutcome::as_wanted);
}

TEST(MtConfiguration, DeviceThatDoesNotAnswerIsLeftInPeaceForEverLonger) {
  Dialogue rig(kUsb, {.deaf_to = 1'000'000});
  rig.measures = false;
  rig.open();
  std::vector<Duration> pauses;
  for (int i = 0; i < 7; ++i) {
    ASSERT_TRUE(rig.becomes(MtState::no_answer));
    const Time begin = rig.now();
    ASSERT_TRUE(rig.becomes(MtState::entering_config));
    pauses.push_back(rig.now() - begin);
  }
  EXPECT_EQ(pauses, (std::vector<Duration>{milliseconds{500}, seconds{1}, seconds{2}, seconds{4},
                                           seconds{8}, seconds{8}, seconds{8}}));
}

TEST(MtConfiguration, DeviceThatComesBackAfterLongIsConfigured) {
  Dialogue rig(kUsb);
  rig.connected = false;
  rig.open();
  ASSERT_TRUE(rig.becomes(MtState::no_answer));
  rig.pass(seconds{60});
  rig.connected = true;
  EXPECT_TRUE(rig.becomes(MtState::measuring));
}

TEST(MtConfiguration, SilentDeviceIsConfiguredAnew) {
  Dialogue rig(kUsb);
  rig.open();
  ASSERT_TRUE(rig.becomes(MtState::measuring));
  rig.pass(seconds{10});
  EXPECT_EQ(rig.configuration.counters().silences.value(), 0U);
  rig.measures = false;
  rig.pass(milliseconds{1900});
  EXPECT_EQ(rig.configuration.state(), MtState::measuring);
  rig.pass(milliseconds{200});
  EXPECT_EQ(rig.configuration.counters().silences.value(), 1U);
  rig.measures = true;
  EXPECT_TRUE(rig.becomes(MtState::measuring));
  EXPECT_EQ(rig.configuration.counters().dialogues.value(), 2U);
}

TEST(MtConfiguration, RefusedOutputsLeaveADeviceThatMeasures) {
  Dialogue rig(kUsb, {.refuse_with = 33});
  rig.open();
  ASSERT_TRUE(rig.becomes(MtState::measuring));
  EXPECT_TRUE(rig.device().measuring());
  EXPECT_EQ(rig.configuration.outcome(), MtOutcome::refused);
  EXPECT_EQ(rig.configuration.last_error(), 33);
  EXPECT_GE(rig.configuration.counters().errors.value(), 1U);
}

TEST(MtConfiguration, OtherOutputsThanAskedForAreReported) {
  Dialogue rig(kUsb, {.deny_rates = true});
  rig.open();
  ASSERT_TRUE(rig.becomes(MtState::measuring));
  EXPECT_EQ(rig.configuration.outcome(), MtOutcome::differs);
}

TEST(MtConfiguration, LineIsSetToItsRateWhenTheDeviceTakesItAfterAReset) {
  Dialogue rig(kFaster);
  rig.open();
  ASSERT_TRUE(rig.becomes(MtState::measuring));
  EXPECT_EQ(rig.device().baud(), 460800U);
  EXPECT_EQ(rig.configuration.baud(), 460800U);
  EXPECT_EQ(rig.device().outputs(), outputs(400));
}

TEST(MtConfiguration, LineIsSetToItsRateWhenTheDeviceTakesItAtOnce) {
  Dialogue rig(kFaster, {.baud_at_once = true});
  rig.open();
  ASSERT_TRUE(rig.becomes(MtState::measuring));
  EXPECT_EQ(rig.device().baud(), 460800U);
  EXPECT_EQ(rig.configuration.baud(), 460800U);
  EXPECT_EQ(rig.device().outputs(), outputs(400));
}

TEST(MtConfiguration, DeviceThatIsAtTheNewRateAlreadyIsFoundThere) {
  Dialogue rig(kFaster, {.baud = 460800});
  rig.open();
  ASSERT_TRUE(rig.becomes(MtState::measuring));
  EXPECT_EQ(rig.configuration.baud(), 460800U);
  EXPECT_EQ(rig.sent(MessageId::baudrate), 0);
}

TEST(MtConfiguration, DeviceIsNotSetToARateThatTheHostDoesNotHave) {
  Dialogue rig(kFaster);
  rig.fastest = 230400;
  rig.open();
  ASSERT_TRUE(rig.becomes(MtState::measuring));
  EXPECT_EQ(rig.device().baud(), 115200U);
  EXPECT_EQ(rig.sent(MessageId::baudrate), 0);
  EXPECT_EQ(rig.device().outputs(), outputs(100));
}

TEST(MtConfiguration, RateThatTheLineCarriesServesWhereItsOwnCannotBeSet) {
  Dialogue rig({.baud = 115200});
  rig.open();
  ASSERT_TRUE(rig.becomes(MtState::measuring));
  EXPECT_EQ(rig.device().outputs(), outputs(100));
  EXPECT_EQ(rig.configuration.counters().slower_lines.value(), 1U);
}

TEST(MtConfiguration, EveryRateIsFoundByScanning) {
  for (const BaudCode& row : kBaudCodes) {
    if (row.baud == 14400 || row.baud == 28800 || row.baud == 76800) continue;  // not in termios
    Dialogue rig({.baud = 115200, .scan_baud = true, .rate_hz = 1}, {.baud = row.baud});
    rig.open();
    ASSERT_TRUE(rig.becomes(MtState::measuring)) << row.baud;
    EXPECT_EQ(rig.configuration.baud(), row.baud);
  }
}

TEST(MtConfiguration, OtherRatesAreNotTriedUnlessWanted) {
  Dialogue rig({.baud = 115200}, {.baud = 921600});
  rig.open();
  ASSERT_TRUE(rig.becomes(MtState::no_answer));
  EXPECT_EQ(rig.configuration.baud(), 115200U);
}

TEST(MtConfiguration, DeviceThatSendsButDoesNotListenIsStillHeard) {
  Dialogue rig({.baud = 115200, .scan_baud = true}, {.baud = 230400, .deaf_to = 1'000'000});
  rig.open();
  ASSERT_TRUE(rig.becomes(MtState::no_answer));
  EXPECT_EQ(rig.configuration.baud(), 230400U);
}

TEST(MtConfiguration, ClosedLineIsLeftAlone) {
  Dialogue rig(kUsb);
  rig.open();
  rig.configuration.end();
  const auto requests = rig.configuration.counters().requests.value();
  rig.pass(seconds{30});
  EXPECT_EQ(rig.configuration.state(), MtState::off);
  EXPECT_EQ(rig.configuration.counters().requests.value(), requests);
}

TEST(MtConfiguration, AnyFrameInAnyStateIsHarmless) {
  // Every message id with every short payload, in the middle of a dialogue.
  Dialogue rig(kUsb);
  rig.open();
  for (unsigned id = 0; id < 256; ++id) {
    for (std::size_t size = 0; size < 30; ++size) {
      rig.deliver(test::make_frame(static_cast<std::uint8_t>(id), ByteVector(size)));
    }
    rig.pass(milliseconds{10});
  }
  EXPECT_TRUE(rig.becomes(MtState::measuring));
}

}  // namespace
}  // namespace convexcut::xsens
