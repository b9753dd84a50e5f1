// SPDX-License-Identifier: Apache-2.0
#include "drivers/xsens/mt_data_id.hpp"

#include <array>
#include <string_view>

namespace convexcut::xsens {
namespace {

enum class Options : std::uint8_t { none, format, format_and_frame };

struct TypeName {
  DataType type;
  std::string_view name;
  Options options;
};

constexpr std::array kTypeNames = {
    TypeName{DataType::temperature, "Temperature", Options::format},
    TypeName{DataType::utc_time, "UtcTime", Options::none},
    TypeName{DataType::packet_counter, "PacketCounter", Options::none},
    TypeName{DataType::itow, "Itow", Options::none},
    TypeName{DataType::sample_time_fine, "SampleTimeFine", Options::none},
    TypeName{DataType::sample_time_coarse, "SampleTimeCoarse", Options::none},
    TypeName{DataType::sample_time64, "SampleTime64", Options::none},
    TypeName{DataType::packet_counter32, "PacketCounter32", Options::none},
    TypeName{DataType::quaternion, "Quaternion", Options::format_and_frame},
    TypeName{DataType::rotation_matrix, "RotationMatrix", Options::format_and_frame},
    TypeName{DataType::euler_angles, "EulerAngles", Options::format_and_frame},
    TypeName{DataType::baro_pressure, "BaroPressure", Options::none},
    TypeName{DataType::delta_v, "DeltaV", Options::format},
    TypeName{DataType::acceleration, "Acceleration", Options::format},
    TypeName{DataType::free_acceleration, "FreeAcceleration", Options::format},
    TypeName{DataType::acceleration_hr, "AccelerationHR", Options::format},
    TypeName{DataType::altitude_msl, "AltitudeMsl", Options::format},
    TypeName{DataType::altitude_ellipsoid, "AltitudeEllipsoid", Options::format},
    TypeName{DataType::position_ecef, "PositionEcef", Options::format},
    TypeName{DataType::lat_lon, "LatLon", Options::format},
    TypeName{DataType::gnss_pvt, "GnssPvtData", Options::none},
    TypeName{DataType::rate_of_turn, "RateOfTurn", Options::format},
    TypeName{DataType::delta_q, "DeltaQ", Options::format},
    TypeName{DataType::rate_of_turn_hr, "RateOfTurnHR", Options::format},
    TypeName{DataType::magnetic_field, "MagneticField", Options::format},
    TypeName{DataType::velocity, "VelocityXYZ", Options::format_and_frame},
    TypeName{DataType::status_byte, "StatusByte", Options::none},
    TypeName{DataType::status_word, "StatusWord", Options::none},
};

std::string_view name_of(NumberFormat format) {
  switch (format) {
    case NumberFormat::fp12_20:
      return ", fp12.20";
    case NumberFormat::fp16_32:
      return ", fp16.32";
    case NumberFormat::float64:
      return ", float64";
    case NumberFormat::float32:
      break;
  }
  return ", float32";
}

std::string_view name_of(CoordinateSystem frame) {
  switch (frame) {
    case CoordinateSystem::ned:
      return ", NED";
    case CoordinateSystem::nwu:
      return ", NWU";
    case CoordinateSystem::enu:
      break;
  }
  return ", ENU";
}

bool options_fit(std::uint16_t data_id, Options options) {
  const unsigned coordinates = data_id & kCoordinateMask;
  switch (options) {
    case Options::none:
      return (data_id & ~kTypeMask) == 0;
    case Options::format:
      return coordinates == 0;
    case Options::format_and_frame:
      break;
  }
  return coordinates != kReservedCoordinates;
}

}  // namespace

std::string describe_data_id(std::uint16_t data_id) {
  for (const TypeName& entry : kTypeNames) {
    if (entry.type != type_of(data_id) || !options_fit(data_id, entry.options)) continue;
    std::string text(entry.name);
    if (entry.options != Options::none) text += name_of(number_format_of(data_id));
    if (entry.options == Options::format_and_frame) text += name_of(coordinates_of(data_id));
    return text;
  }
  return "unknown";
}

}  // namespace convexcut::xsens
