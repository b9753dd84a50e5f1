// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/nmea.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace convexcut::velodyne {
namespace {

constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

std::optional<unsigned> hex_digit(char c) noexcept {
  if (is_digit(c)) return static_cast<unsigned>(c - '0');
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A' + 10);
  if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a' + 10);
  return std::nullopt;
}

bool checksum_matches(std::string_view body, std::string_view digits) noexcept {
  if (digits.size() != 2) return false;
  const std::optional<unsigned> high = hex_digit(digits[0]);
  const std::optional<unsigned> low = hex_digit(digits[1]);
  if (!high || !low) return false;
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  return sum == *high * 16 + *low;
}

// Comma-separated fields; past the end they are empty.
class Fields {
 public:
  explicit Fields(std::string_view body) noexcept : rest_(body) {}
  std::string_view next() noexcept {
    const std::size_t comma = std::min(rest_.find(','), rest_.size());
    const std::string_view field = rest_.substr(0, comma);
    rest_.remove_prefix(std::min(comma + 1, rest_.size()));
    return field;
  }

 private:
  std::string_view rest_;
};

// "4916.45" → {4916, 450'000'000}. Digits beyond the ninth decimal are dropped.
struct Decimal {
  std::int64_t whole = 0;
  std::int64_t billionths = 0;
};

std::optional<Decimal> parse_decimal(std::string_view text, std::size_t whole_digits) noexcept {
  if (text.size() < whole_digits) return std::nullopt;
  Decimal number;
  for (const char c : text.substr(0, whole_digits)) {
    if (!is_digit(c)) return std::nullopt;
    number.whole = number.whole * 10 + (c - '0');
  }
  const std::string_view rest = text.substr(whole_digits);
  if (rest.empty()) return number;
  if (rest.front() != '.') return std::nullopt;
  std::int64_t place = 100'000'000;
  for (const char c : rest.substr(1)) {
    if (!is_digit(c)) return std::nullopt;
    number.billionths += (c - '0') * place;
    place /= 10;
  }
  return number;
}

// Each parse_… function: false when the field is neither empty nor right; an empty one leaves the
// value unset.

// hhmmss or hhmmss.s…
bool parse_time(std::string_view text, std::optional<Duration>& time) noexcept {
  if (text.empty()) return true;
  const std::optional<Decimal> number = parse_decimal(text, 6);
  if (!number) return false;
  const std::int64_t h = number->whole / 10'000;
  const std::int64_t m = number->whole / 100 % 100;
  const std::int64_t s = number->whole % 100;
  if (h > 23 || m > 59 || s > 60) return false;
  time = std::chrono::hours{h} + std::chrono::minutes{m} + std::chrono::seconds{s} +
         Duration{number->billionths};
  return true;
}

// ddmmyy; 80 … 99 are of the last century: GPS started in 1980.
bool parse_date(std::string_view text, std::optional<std::chrono::year_month_day>& date) noexcept {
  if (text.empty()) return true;
  const std::optional<Decimal> number = parse_decimal(text, 6);
  if (!number || text.size() != 6) return false;
  const auto day = static_cast<unsigned>(number->whole / 10'000);
  const auto month = static_cast<unsigned>(number->whole / 100 % 100);
  const auto yy = static_cast<int>(number->whole % 100);
  const std::chrono::year_month_day read{std::chrono::year{yy < 80 ? 2000 + yy : 1900 + yy},
                                         std::chrono::month{month}, std::chrono::day{day}};
  if (!read.ok()) return false;
  date = read;
  return true;
}

// (d)ddmm.mmmm and a hemisphere.
struct AngleFormat {
  std::size_t whole_digits;
  double max_degrees;
  char positive;
  char negative;
};
constexpr AngleFormat kLatitude{4, 90.0, 'N', 'S'};
constexpr AngleFormat kLongitude{5, 180.0, 'E', 'W'};

bool parse_angle(std::string_view text, std::string_view hemisphere, const AngleFormat& format,
                 std::optional<Degrees>& angle) noexcept {
  if (text.empty()) return true;
  const std::optional<Decimal> number = parse_decimal(text, format.whole_digits);
  if (!number || hemisphere.size() != 1) return false;
  if (hemisphere[0] != format.positive && hemisphere[0] != format.negative) return false;
  const std::int64_t whole_degrees = number->whole / 100;
  const std::int64_t whole_minutes = number->whole % 100;
  if (whole_minutes > 59) return false;
  const double minutes =
      static_cast<double>(whole_minutes) + static_cast<double>(number->billionths) * 1e-9;
  const double degrees = static_cast<double>(whole_degrees) + minutes / 60.0;
  if (degrees > format.max_degrees) return false;
  angle = Degrees{hemisphere[0] == format.positive ? degrees : -degrees};
  return true;
}

bool parse_position(Fields& fields, NmeaFix& fix) noexcept {
  const std::string_view latitude = fields.next();
  const std::string_view north_south = fields.next();
  const std::string_view longitude = fields.next();
  const std::string_view east_west = fields.next();
  return parse_angle(latitude, north_south, kLatitude, fix.latitude) &&
         parse_angle(longitude, east_west, kLongitude, fix.longitude);
}

// time, A|V, latitude, N|S, longitude, E|W, speed, course, date, …
bool parse_rmc(Fields fields, NmeaFix& fix) noexcept {
  if (!parse_time(fields.next(), fix.time_of_day)) return false;
  const std::string_view status = fields.next();
  if (status != "A" && status != "V") return false;
  fix.valid = status == "A";
  if (!parse_position(fields, fix)) return false;
  fields.next();  // speed
  fields.next();  // course
  return parse_date(fields.next(), fix.date);
}

// time, latitude, N|S, longitude, E|W, quality, …
bool parse_gga(Fields fields, NmeaFix& fix) noexcept {
  if (!parse_time(fields.next(), fix.time_of_day)) return false;
  if (!parse_position(fields, fix)) return false;
  const std::string_view quality = fields.next();
  if (quality.size() != 1 || !is_digit(quality[0])) return false;
  fix.valid = quality[0] != '0';
  return true;
}

}  // namespace

NmeaStatus parse_nmea(std::string_view text, NmeaFix& fix) noexcept {
  constexpr std::string_view kEnds{"\r\n\0", 3};
  text = text.substr(0, text.find_first_of(kEnds));
  if (text.empty()) return NmeaStatus::absent;
  if (text.front() != '$') return NmeaStatus::malformed;
  text.remove_prefix(1);
  const std::size_t star = text.find('*');
  if (star == std::string_view::npos) return NmeaStatus::bad_checksum;
  const std::string_view body = text.substr(0, star);
  if (!checksum_matches(body, text.substr(star + 1))) return NmeaStatus::bad_checksum;

  Fields fields(body);
  const std::string_view address = fields.next();  // two letters of talker, three of sentence
  if (address.size() != 5) return NmeaStatus::unsupported;
  const std::string_view sentence = address.substr(2);
  NmeaFix read;
  bool good = false;
  if (sentence == "RMC") {
    good = parse_rmc(fields, read);
  } else if (sentence == "GGA") {
    good = parse_gga(fields, read);
  } else {
    return NmeaStatus::unsupported;
  }
  if (!good) return NmeaStatus::malformed;
  fix = read;
  return NmeaStatus::ok;
}

}  // namespace convexcut::velodyne
