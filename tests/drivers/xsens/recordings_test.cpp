// SPDX-License-Identifier: Apache-2.0
//
// Every value of three real MTi-G-710 recordings against the text that another decoder (xsens-go)
// made of them. Does not prove items that these recordings do not hold, nor an MTi-30's selection.
#include "tests/support/recordings.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "drivers/xsens/imu_driver.hpp"
#include "drivers/xsens/mt_statistics.hpp"
#include "drivers/xsens/mtdata2.hpp"
#include "drivers/xsens/xbus_framer.hpp"
#include "tests/drivers/xsens/recording_sink.hpp"

namespace convexcut::xsens {
namespace {

// One message of the text: item name → value lines, as they stand.
using TextMessage = std::map<std::string, std::vector<std::string>>;

std::vector<TextMessage> read_text(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<TextMessage> messages(1);
  std::string item;
  for (std::string line; std::getline(in, line);) {
    if (line.empty()) {
      messages.emplace_back();
    } else if (line.starts_with("  ")) {
      messages.back()[item].push_back(line.substr(2));
    } else {
      item = line.substr(0, line.find(':'));
    }
  }
  if (messages.back().empty()) messages.pop_back();
  return messages;
}

std::vector<MtMeasurement> read_stream(const std::filesystem::path& file) {
  std::vector<MtMeasurement> measurements;
  XbusCounters counters;
  XbusFramer framer(counters);
  framer.feed(convexcut::test::read_bytes(file), [&](const XbusFrame& frame) {
    EXPECT_EQ(frame.message_id, 0x36);
    EXPECT_EQ(parse_mtdata2(frame.payload, measurements.emplace_back()), PayloadStatus::ok);
  });
  EXPECT_EQ(counters.skipped_bytes.value() + framer.pending(), 0U);
  return measurements;
}

std::string binary(std::uint32_t word, int bits) {
  std::string text;
  for (int bit = bits - 1; bit >= 0; --bit) text += ((word >> bit) & 1U) != 0 ? '1' : '0';
  return text;
}

// RFC 3339 with the fraction's trailing zeros left out, as Go prints it.
std::string rfc3339(const UtcTime& utc) {
  char text[64];
  std::snprintf(text, sizeof text, "%04d-%02d-%02dT%02d:%02d:%02d.%09u", utc.year, utc.month,
                utc.day, utc.hour, utc.minute, utc.second, utc.nanosecond);
  std::string trimmed(text);
  trimmed.erase(trimmed.find_last_not_of('0') + 1);
  if (trimmed.back() == '.') trimmed.pop_back();
  return trimmed + 'Z';
}

// Compares one message and takes each item it has compared out of both sides.
class MessageComparison {
 public:
  MessageComparison(TextMessage text, const MtMeasurement& m) : text_(std::move(text)), m_(m) {}

  // The number of values; fails for items that only one side has.
  std::size_t compare(const std::string& format) {
    exact("PacketCounter", MtItem::packet_counter, std::to_string(m_.packet_counter));
    exact("SampleTimeFine", MtItem::sample_time_fine, std::to_string(m_.sample_time_fine));
    exact("UTCTime", MtItem::utc_time, rfc3339(m_.utc));
    exact("StatusWord", MtItem::status_word, binary(m_.status_word, 32));
    exact("StatusByte", MtItem::status_byte, binary(m_.status_byte, 8));
    const std::string suffix = "(" + format + ")";
    const std::string enu = "(EastNorthUp," + format + ")";
    in_frame("EulerAngles" + enu, MtItem::euler_angles, m_.euler_deg);
    in_frame("VelocityXYZ" + enu, MtItem::velocity, m_.velocity_m_s);
    reals("Acceleration" + suffix, MtItem::acceleration, m_.acceleration_m_s2);
    reals("DeltaV" + suffix, MtItem::delta_v, m_.delta_v_m_s);
    reals("RateOfTurn" + suffix, MtItem::rate_of_turn, m_.rate_of_turn_rad_s);
    reals("DeltaQ" + suffix, MtItem::delta_q, m_.delta_q);
    reals("LatLon" + suffix, MtItem::lat_lon, m_.lat_lon_deg);
    reals("AltitudeEllipsoid" + suffix, MtItem::altitude_ellipsoid, m_.altitude_ellipsoid_m);
    gnss_pvt();
    EXPECT_TRUE(text_.empty()) << "not compared: " << text_.begin()->first;
    EXPECT_EQ(m_.items, 0U) << "items that the text does not have";
    return values_;
  }

 private:
  std::vector<std::string> take(const std::string& name, MtItem item) {
    const auto found = text_.find(name);
    EXPECT_EQ(found != text_.end(), m_.has(item)) << name;
    if (found == text_.end()) return {};
    std::vector<std::string> lines = found->second;
    text_.erase(found);
    m_.items &= ~MtMeasurement::bit(item);
    values_ += lines.size();
    return lines;
  }

  void exact(const std::string& name, MtItem item, const std::string& value) {
    const auto lines = take(name, item);
    if (!lines.empty()) {
      EXPECT_EQ(lines, std::vector<std::string>{value}) << name;
    }
  }

  template <std::size_t N>
  void reals(const std::string& name, MtItem item, const Reals<N>& values) {
    const auto lines = take(name, item);
    if (lines.empty()) return;
    ASSERT_EQ(lines.size(), N) << name;
    for (std::size_t i = 0; i < N; ++i) {
      const std::string number = lines[i].substr(lines[i].find(':') + 1);
      // The text has every digit of the double that the wire's number is.
      EXPECT_EQ(values[i], std::stod(number)) << name << ' ' << lines[i];
    }
  }

  template <std::size_t N>
  void in_frame(const std::string& name, MtItem item, const InFrame<N>& values) {
    if (m_.has(item)) {
      EXPECT_EQ(values.frame, CoordinateSystem::enu);
    }
    reals(name, item, values.value);
  }

  void gnss_pvt() {
    const auto lines = take("GNSSPVTData", MtItem::gnss_pvt);
    if (lines.empty()) return;
    const GnssPvt& p = m_.gnss_pvt;
    std::ostringstream ours;
    ours << "ITOW:" << p.itow_ms << " Year:" << p.year << " Month:" << +p.month << " Day:" << +p.day
         << " Hour:" << +p.hour << " Min:" << +p.minute << " Sec:" << +p.second
         << " Valid:" << +p.valid << " TAcc:" << p.time_accuracy_ns << " Nano:" << p.nanosecond
         << " FixType:" << +p.fix_type << " Flags:" << +p.flags << " NumSV:" << +p.satellites
         << " Reserved1:" << +p.reserved << " Lon:" << p.longitude_1e7_deg
         << " Lat:" << p.latitude_1e7_deg << " Height:" << p.height_ellipsoid_mm
         << " HMSL:" << p.height_msl_mm << " HAcc:" << p.horizontal_accuracy_mm
         << " VAcc:" << p.vertical_accuracy_mm << " VelN:" << p.velocity_north_mm_s
         << " VelE:" << p.velocity_east_mm_s << " VelD:" << p.velocity_down_mm_s
         << " GSpeed:" << p.ground_speed_mm_s << " HeadMot:" << p.heading_of_motion_1e5_deg
         << " SAcc:" << p.speed_accuracy_mm_s << " HeadAcc:" << p.heading_accuracy_1e5_deg
         << " HeadVeh:" << p.heading_of_vehicle_1e5_deg << " GDOP:" << p.gdop << " PDOP:" << p.pdop
         << " TDOP:" << p.tdop << " VDOP:" << p.vdop << " HDOP:" << p.hdop << " NDOP:" << p.ndop
         << " EDOP:" << p.edop;
    std::string theirs;
    for (const std::string& line : lines) theirs += (theirs.empty() ? "" : " ") + line;
    EXPECT_EQ(ours.str(), theirs);
  }

  TextMessage text_;
  MtMeasurement m_;
  std::size_t values_ = 0;
};

struct Golden {
  const char* name;
  const char* format;
  std::size_t values;  // value lines that the text holds
};

class MtRecordings : public testing::TestWithParam<Golden> {};

TEST_P(MtRecordings, EveryValueEqualsTheText) {
  const std::string base = std::string("imu/") + GetParam().name;
  CONVEXCUT_NEEDS_RECORDING(stream, base + ".bin");
  CONVEXCUT_NEEDS_RECORDING(text, base + ".txt");
  const std::vector<MtMeasurement> measurements = read_stream(stream);
  const std::vector<TextMessage> messages = read_text(text);
  ASSERT_EQ(measurements.size(), 100U);
  ASSERT_EQ(messages.size(), 100U);
  std::size_t values = 0;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    SCOPED_TRACE("message " + std::to_string(i));
    values += MessageComparison(messages[i], measurements[i]).compare(GetParam().format);
  }
  EXPECT_EQ(values, GetParam().values);
}

TEST_P(MtRecordings, DriverMakesASampleOfEveryInertialMessage) {
  CONVEXCUT_NEEDS_RECORDING(stream, std::string("imu/") + GetParam().name + ".bin");
  convexcut::test::RecordingSink sink;
  ImuDriver driver({.baud = 115200, .unstamped_start = HostTime{}}, sink);
  driver.on_bytes(convexcut::test::read_bytes(stream), HostTime{});
  EXPECT_EQ(sink.samples.size(), 96U);
  EXPECT_EQ(driver.counters().without_inertial.value(), 4U);  // the GNSS messages
  EXPECT_EQ(driver.counters().lost_messages.value(), 0U);
  // 100 Hz throughout: the older GNSS messages leave no step in the samples around them.
  EXPECT_NEAR(static_cast<double>(to_ns(sink.samples.back().arrival)), 0.95e9, 0.011e9);
  for (std::size_t i = 1; i < sink.samples.size(); ++i) {
    const Duration step = sink.samples[i].device_time - sink.samples[i - 1].device_time;
    EXPECT_EQ(step, std::chrono::milliseconds{10}) << i;
  }
  EXPECT_FALSE(sink.samples.front().has_orientation) << "unavailable items are left out";
  EXPECT_NEAR(sink.samples.back().acceleration_m_s2.norm(), 9.81F, 0.1F);
}

TEST_P(MtRecordings, StatisticsGiveTheRates) {
  CONVEXCUT_NEEDS_RECORDING(stream, std::string("imu/") + GetParam().name + ".bin");
  MtStatistics statistics;
  statistics.on_bytes(convexcut::test::read_bytes(stream));
  EXPECT_EQ(statistics.items().at(0x1020).count, 100U);
  EXPECT_EQ(statistics.items().at(0x7010).count, 4U);
  EXPECT_EQ(statistics.items().at(0x7010).largest, 94);
  const auto acceleration = statistics.items().lower_bound(0x4020);
  EXPECT_NEAR(acceleration->second.rate_hz().value(), 100.0, 1.0);
}

INSTANTIATE_TEST_SUITE_P(MtiG710, MtRecordings,
                         testing::Values(Golden{"mti_g710_1", "Float32", 2525},
                                         Golden{"mti_g710_2", "FP1220", 2597},
                                         Golden{"mti_g710_3", "FP1632", 2513}),
                         [](const auto& golden) { return std::string(golden.param.format); });

}  // namespace
}  // namespace convexcut::xsens
