// SPDX-License-Identifier: Apache-2.0
//
// The GPS receiver's sentence that a position packet passes on: RMC, from some receivers GGA, of
// any talker ($GPRMC, $GNRMC …). NMEA 0183.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/angle.hpp"
#include "core/time.hpp"

namespace convexcut::velodyne {

enum class NmeaStatus : std::uint8_t {
  ok,
  absent,        // the field is empty: no receiver, or none heard yet
  malformed,     // not a sentence, or a field of it is not what it should be
  bad_checksum,  // or none
  unsupported,   // a well-formed sentence other than RMC and GGA
};

struct NmeaFix {
  bool valid = false;  // RMC status A, GGA quality above 0
  // Since midnight UTC. 23:59:60 is one day: leap seconds are counted as the receiver does.
  std::optional<Duration> time_of_day;
  std::optional<std::chrono::year_month_day> date;  // RMC only
  std::optional<Degrees> latitude;                  // north positive
  std::optional<Degrees> longitude;                 // east positive
};

// `text` ends at its first CR, LF or NUL; what follows is ignored. Empty fields are allowed (a
// receiver without a fix sends them). Sets `fix` only with status ok.
// Thread: any. RT: no allocation, no lock, no locale.
[[nodiscard]] NmeaStatus parse_nmea(std::string_view text, NmeaFix& fix) noexcept;

}  // namespace convexcut::velodyne
