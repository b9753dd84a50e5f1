// SPDX-License-Identifier: Apache-2.0
//
// Complete Xbus frames, of the protocol documentation and of real devices (docs/design/imu.md names
// the sources), and a builder for others.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "drivers/xsens/xbus.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::xsens::test {

using convexcut::test::hex;

inline constexpr std::string_view kGoToConfig = "FA FF 30 00 D1";
inline constexpr std::string_view kGoToConfigAck = "FA FF 31 00 D0";
inline constexpr std::string_view kGoToMeasurement = "FA FF 10 00 F1";
inline constexpr std::string_view kGoToMeasurementAck = "FA FF 11 00 F0";
inline constexpr std::string_view kReqDeviceId = "FA FF 00 00 01";
inline constexpr std::string_view kReset = "FA FF 40 00 C1";
inline constexpr std::string_view kWakeUp = "FA FF 3E 00 C3";
inline constexpr std::string_view kWakeUpAck = "FA FF 3F 00 C2";
inline constexpr std::string_view kReqOutputConfiguration = "FA FF C0 00 41";
inline constexpr std::string_view kReqFirmwareRevision = "FA FF 12 00 EF";
inline constexpr std::string_view kReqProductCode = "FA FF 1C 00 E5";
inline constexpr std::string_view kReqBaudrate = "FA FF 18 00 E9";
inline constexpr std::string_view kSetBaudrate921600 = "FA FF 18 01 80 68";
inline constexpr std::string_view kBaudrateAck = "FA FF 19 00 E8";
inline constexpr std::string_view kSetBaudrate115200 = "FA FF 18 01 02 E6";
inline constexpr std::string_view kSetBaudrate230400 = "FA FF 18 01 01 E7";
inline constexpr std::string_view kSetBaudrate460800 = "FA FF 18 01 00 E8";
inline constexpr std::string_view kErrorInvalidParameter = "FA FF 42 01 21 9D";
inline constexpr std::string_view kFirmwareRevision =
    "FA FF 13 0B 01 08 02 00 00 00 25 00 01 15 34 69";
inline constexpr std::string_view kOutputConfigurationAck =
    "FA FF C1 08 10 20 FF FF 10 60 FF FF 9C";
inline constexpr std::string_view kSetFilterProfile = "FA FF 64 02 00 02 99";
inline constexpr std::string_view kFilterProfileAck = "FA FF 65 00 9C";
inline constexpr std::string_view kSetOutputConfiguration =
    "FA FF C0 18 10 20 FF FF 10 60 FF FF 20 10 01 90 40 20 01 90 80 20 01 90 E0 20 FF FF "
    "AC";
inline constexpr std::string_view kSetOutputConfigurationTwelve =
    "FA FF C0 30 10 20 FF FF 10 60 FF FF 20 10 01 90 40 20 01 90 40 10 01 90 40 30 01 90 "
    "80 20 01 90 80 30 01 90 C0 20 00 64 08 10 00 0A 30 10 00 32 E0 20 FF FF 99";
inline constexpr std::string_view kOfficialExample =
    "FA FF 36 31 10 20 02 DF C5 10 60 04 00 45 9D A0 40 20 0C BE DC 9A FA 3F 54 9F 37 41 "
    "1C BB 70 80 20 0C BB AA 5C 80 3B 8C 55 01 BB 81 33 00 E0 20 04 00 00 00 81 45";
inline constexpr std::string_view kQuaternionMessage =
    "FA FF 36 26 10 20 02 46 82 10 60 04 01 C4 FC 3E 20 10 10 3F 71 CE 6C BE A5 6B CF 3C "
    "61 3B D8 BD 69 1D 25 E0 20 04 00 40 00 03 12";
inline constexpr std::string_view kImuSetMessage =
    "FA FF 36 75 10 20 02 8D 90 10 60 04 00 54 DB F1 20 10 10 3F 7F 89 11 BC 11 1D FA 3B "
    "A0 CE F0 BD 73 25 73 40 20 0C BD DC F9 D0 BE 3C 86 19 41 1D 0B 47 40 10 0C B9 8D B0 "
    "00 B9 F1 48 00 3C C9 04 30 40 30 0C BC B9 89 2E BB 09 8C 00 3C A7 08 00 80 20 0C BA "
    "63 BC 01 BC 04 D6 3F BB 6D E3 FE 80 30 10 3F 80 00 01 B5 91 C0 00 B7 2A 08 00 B6 98 "
    "40 00 E0 20 04 00 40 00 03 77";
inline constexpr std::string_view kFloat32Message =
    "FA FF 36 71 10 20 02 A9 87 10 60 04 03 14 ED B7 10 10 0C 07 DC A2 60 07 E3 01 14 0D "
    "2F 18 37 E0 20 04 00 00 00 05 20 30 0C C2 C6 EC 74 3E 08 3F 53 C3 33 30 CB 40 20 0C "
    "3C E7 E9 CB C1 1A 8E 2F BF D0 4D 0C 40 10 0C 39 93 13 23 BD C5 D4 9B BC 85 52 C4 80 "
    "20 0C 3A B2 1F 42 BB 51 3A B9 BB 51 E9 4C 80 30 10 3F 80 00 01 36 E3 FF 0C B7 85 E8 "
    "22 B7 86 57 DF 19";
inline constexpr std::string_view kFp1220Message =
    "FA FF 36 6E 10 20 02 A9 EB 10 60 04 03 15 19 3E 10 10 0C 0E AC B6 C0 07 E3 01 14 0D "
    "2F 19 37 E0 10 01 05 20 31 0C F9 C3 C6 08 FF FC 29 2D 0B 29 F1 10 40 21 0C 00 00 BB "
    "67 FF 65 01 F0 FF E5 F2 87 40 11 0C 00 00 01 DC FF FE 73 39 FF FF BD 4F 80 21 0C FF "
    "FF FE E2 FF FF F3 0F FF FF ED 46 80 31 10 00 10 00 01 00 00 00 00 FF FF FF F0 FF FF "
    "FF E9 DB";
inline constexpr std::string_view kFp1632Message =
    "FA FF 36 8E 10 20 02 AA 4F 10 60 04 03 15 44 D2 10 10 0C 15 90 A1 40 07 E3 01 14 0D "
    "2F 1A 37 E0 10 01 05 20 32 12 7A D5 00 00 FF 9C A4 68 31 80 FF FF DF A7 00 00 00 B1 "
    "40 22 12 07 0D 5E E8 00 00 52 87 30 00 FF F6 59 CC 80 00 FF FE 40 12 12 00 11 F7 E6 "
    "00 00 E7 39 AD C0 FF FF FB C7 20 50 FF FF 80 22 12 00 28 8D 69 00 00 FF 6C 6B 02 FF "
    "FF FF 8E A4 DB FF FF 80 32 18 00 00 00 01 00 01 00 00 33 E8 00 00 FF FF 43 18 FF FF "
    "FF FF 6E E8 FF FF 3F";
inline constexpr std::string_view kFloat64Message =
    "FA FF 36 AE 10 20 02 AA B3 10 60 04 03 15 70 56 10 10 0C 1C 5C 21 C0 07 E3 01 14 0D "
    "2F 1B 37 E0 10 01 05 20 33 18 C0 58 DF CB A0 00 00 00 BF A1 18 AB E0 00 00 00 40 66 "
    "79 C9 A0 00 00 00 40 23 18 3F 9A 8E 06 00 00 00 00 C0 23 5D 70 E0 00 00 00 BF FA 67 "
    "25 40 00 00 00 40 13 18 3F 30 E9 5D 20 00 00 00 BF B8 C9 88 C0 00 00 00 BF 90 E5 A0 "
    "60 00 00 00 80 23 18 BF 4D 16 DD 80 00 00 00 BF 58 F1 ED 40 00 00 01 BF 59 CE 41 80 "
    "00 00 00 80 33 20 3F F0 00 00 00 00 00 01 BE D2 9D FE 60 00 00 00 BE DF ED FC 80 00 "
    "00 00 BE E0 84 01 00 00 00 00 15";
inline constexpr std::string_view kNoInertialMessage =
    "FA FF 36 46 10 20 02 AB 17 10 60 04 03 15 9B 86 10 70 04 00 00 14 36 10 10 0C 22 A7 "
    "75 C0 07 E3 01 14 0D 2F 1C 37 E0 20 04 01 80 00 05 08 10 04 42 13 40 00 C0 20 0C 3D "
    "85 D1 EC 3E 44 67 1A 3E 1A A0 69 30 10 04 00 01 8C 10 73";

inline constexpr std::array kAllFrames = {kGoToConfig,
                                          kGoToConfigAck,
                                          kGoToMeasurement,
                                          kGoToMeasurementAck,
                                          kReqDeviceId,
                                          kReset,
                                          kWakeUp,
                                          kWakeUpAck,
                                          kReqOutputConfiguration,
                                          kReqFirmwareRevision,
                                          kReqProductCode,
                                          kReqBaudrate,
                                          kSetBaudrate921600,
                                          kBaudrateAck,
                                          kSetBaudrate115200,
                                          kSetBaudrate230400,
                                          kSetBaudrate460800,
                                          kErrorInvalidParameter,
                                          kFirmwareRevision,
                                          kOutputConfigurationAck,
                                          kSetFilterProfile,
                                          kFilterProfileAck,
                                          kSetOutputConfiguration,
                                          kSetOutputConfigurationTwelve,
                                          kOfficialExample,
                                          kQuaternionMessage,
                                          kImuSetMessage,
                                          kFloat32Message,
                                          kFp1220Message,
                                          kFp1632Message,
                                          kFloat64Message,
                                          kNoInertialMessage};
// Those that hold orientation, rate of turn or acceleration.
inline constexpr std::array kInertialMessages = {
    kOfficialExample, kQuaternionMessage, kImuSetMessage, kFloat32Message,
    kFp1220Message,   kFp1632Message,     kFloat64Message};

using ByteVector = std::vector<std::byte>;

inline void append(ByteVector& to, const ByteVector& bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

// Sets the checksum of a whole frame.
inline void seal(ByteVector& frame) {
  std::uint8_t sum = 0;
  for (std::size_t i = 1; i + 1 < frame.size(); ++i) {
    sum = static_cast<std::uint8_t>(sum + static_cast<std::uint8_t>(frame[i]));
  }
  frame.back() = static_cast<std::byte>(-sum);
}

// A frame with the extended length where it is needed.
inline ByteVector make_frame(std::uint8_t message_id, const ByteVector& payload) {
  ByteVector frame = {std::byte{kPreamble}, std::byte{kBusId}, std::byte{message_id}};
  if (payload.size() < kExtendedLength) {
    frame.push_back(static_cast<std::byte>(payload.size()));
  } else {
    frame.push_back(std::byte{kExtendedLength});
    frame.push_back(static_cast<std::byte>(payload.size() >> 8U));
    frame.push_back(static_cast<std::byte>(payload.size()));
  }
  append(frame, payload);
  frame.push_back(std::byte{0});
  seal(frame);
  return frame;
}

inline ByteVector make_data_message(std::string_view payload_hex) {
  return make_frame(static_cast<std::uint8_t>(MessageId::mtdata2), hex(payload_hex));
}

// The payload of a frame with a plain length.
inline ByteVector payload_of(const ByteVector& frame) {
  return {frame.begin() + kHeaderSize, frame.end() - kChecksumSize};
}

}  // namespace convexcut::xsens::test
