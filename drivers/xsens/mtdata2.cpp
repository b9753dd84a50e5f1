// SPDX-License-Identifier: Apache-2.0
#include "drivers/xsens/mtdata2.hpp"

#include <bit>

namespace convexcut::xsens {
namespace {

// UTC time item, 12 bytes.
constexpr std::size_t kUtcNanosecondOffset = 0;
constexpr std::size_t kUtcYearOffset = 4;
constexpr std::size_t kUtcMonthOffset = 6;
constexpr std::size_t kUtcDayOffset = 7;
constexpr std::size_t kUtcHourOffset = 8;
constexpr std::size_t kUtcMinuteOffset = 9;
constexpr std::size_t kUtcSecondOffset = 10;
constexpr std::size_t kUtcFlagsOffset = 11;
constexpr std::size_t kUtcSize = 12;
static_assert(kUtcFlagsOffset + 1 == kUtcSize);

// fp16.32: the fraction comes first on the wire.
constexpr std::size_t kFractionOffset = 0;
constexpr std::size_t kIntegerOffset = 4;
static_assert(kIntegerOffset + sizeof(std::int16_t) == size_of(NumberFormat::fp16_32));

// Decodes one item at a time into a measurement, and remembers whether all were of the right size.
class ItemDecoder {
 public:
  explicit ItemDecoder(MtMeasurement& measurement) noexcept : m_(measurement) {}

  void decode(const RawItem& item) noexcept {
    const bool has_format = (item.data_id & ~kTypeMask) != 0;
    if (has_format || !decode_plain(item)) decode_real(item);
  }
  [[nodiscard]] bool all_sizes_right() const noexcept { return all_sizes_right_; }

 private:
  // Items without a number format: their low four bits are zero. False: not one of them.
  bool decode_plain(const RawItem& item) noexcept;
  void decode_real(const RawItem& item) noexcept;
  void decode_in_frame(const RawItem& item) noexcept;
  void utc(const RawItem& item) noexcept;
  void gnss_pvt(const RawItem& item) noexcept;

  bool check_size(const RawItem& item, std::size_t expected) noexcept {
    if (item.data.size() == expected) return true;
    all_sizes_right_ = false;
    return false;
  }

  template <std::integral T>
  void integer(const RawItem& item, T& out, MtItem kind) noexcept {
    if (!check_size(item, sizeof(T))) return;
    out = wire::load_be<T>(item.data, 0);
    m_.add(kind);
  }

  template <std::size_t N>
  void reals(const RawItem& item, Reals<N>& out, MtItem kind) noexcept {
    const NumberFormat format = number_format_of(item.data_id);
    if (!check_size(item, N * size_of(format))) return;
    for (std::size_t i = 0; i < N; ++i) out[i] = load_real(item.data, i * size_of(format), format);
    m_.add(kind);
  }

  template <std::size_t N>
  void in_frame(const RawItem& item, InFrame<N>& out, MtItem kind) noexcept {
    reals(item, out.value, kind);
    out.frame = coordinates_of(item.data_id);
  }

  MtMeasurement& m_;
  bool all_sizes_right_ = true;
};

bool ItemDecoder::decode_plain(const RawItem& item) noexcept {
  switch (type_of(item.data_id)) {
    case DataType::utc_time:
      utc(item);
      return true;
    case DataType::packet_counter:
      integer(item, m_.packet_counter, MtItem::packet_counter);
      return true;
    case DataType::itow:
      integer(item, m_.itow_ms, MtItem::itow);
      return true;
    case DataType::sample_time_fine:
      integer(item, m_.sample_time_fine, MtItem::sample_time_fine);
      return true;
    case DataType::sample_time_coarse:
      integer(item, m_.sample_time_coarse, MtItem::sample_time_coarse);
      return true;
    case DataType::sample_time64:
      integer(item, m_.sample_time64, MtItem::sample_time64);
      return true;
    case DataType::packet_counter32:
      integer(item, m_.packet_counter32, MtItem::packet_counter32);
      return true;
    case DataType::baro_pressure: {
      std::uint32_t pressure_pa = 0;
      integer(item, pressure_pa, MtItem::baro_pressure);
      m_.baro_pressure_pa = pressure_pa;
      return true;
    }
    case DataType::gnss_pvt:
      gnss_pvt(item);
      return true;
    case DataType::status_byte:
      integer(item, m_.status_byte, MtItem::status_byte);
      return true;
    case DataType::status_word:
      integer(item, m_.status_word, MtItem::status_word);
      return true;
    default:
      return false;
  }
}

void ItemDecoder::decode_real(const RawItem& item) noexcept {
  if ((item.data_id & kCoordinateMask) != 0) {
    decode_in_frame(item);
    return;
  }
  switch (type_of(item.data_id)) {
    case DataType::temperature:
      return reals(item, m_.temperature_c, MtItem::temperature);
    case DataType::delta_v:
      return reals(item, m_.delta_v_m_s, MtItem::delta_v);
    case DataType::acceleration:
      return reals(item, m_.acceleration_m_s2, MtItem::acceleration);
    case DataType::free_acceleration:
      return reals(item, m_.free_acceleration_m_s2, MtItem::free_acceleration);
    case DataType::acceleration_hr:
      return reals(item, m_.acceleration_hr_m_s2, MtItem::acceleration_hr);
    case DataType::altitude_msl:
      return reals(item, m_.altitude_msl_m, MtItem::altitude_msl);
    case DataType::altitude_ellipsoid:
      return reals(item, m_.altitude_ellipsoid_m, MtItem::altitude_ellipsoid);
    case DataType::position_ecef:
      return reals(item, m_.position_ecef_m, MtItem::position_ecef);
    case DataType::lat_lon:
      return reals(item, m_.lat_lon_deg, MtItem::lat_lon);
    case DataType::rate_of_turn:
      return reals(item, m_.rate_of_turn_rad_s, MtItem::rate_of_turn);
    case DataType::delta_q:
      return reals(item, m_.delta_q, MtItem::delta_q);
    case DataType::rate_of_turn_hr:
      return reals(item, m_.rate_of_turn_hr_rad_s, MtItem::rate_of_turn_hr);
    case DataType::magnetic_field:
      return reals(item, m_.magnetic_field, MtItem::magnetic_field);
    default:
      return decode_in_frame(item);
  }
}

void ItemDecoder::decode_in_frame(const RawItem& item) noexcept {
  if ((item.data_id & kCoordinateMask) == kReservedCoordinates) return;
  switch (type_of(item.data_id)) {
    case DataType::quaternion:
      return in_frame(item, m_.quaternion, MtItem::quaternion);
    case DataType::rotation_matrix:
      return in_frame(item, m_.rotation_matrix, MtItem::rotation_matrix);
    case DataType::euler_angles:
      return in_frame(item, m_.euler_deg, MtItem::euler_angles);
    case DataType::velocity:
      return in_frame(item, m_.velocity_m_s, MtItem::velocity);
    default:
      return;
  }
}

void ItemDecoder::utc(const RawItem& item) noexcept {
  if (!check_size(item, kUtcSize)) return;
  m_.utc = {wire::load_be<std::uint32_t>(item.data, kUtcNanosecondOffset),
            wire::load_be<std::uint16_t>(item.data, kUtcYearOffset),
            wire::load_u8(item.data, kUtcMonthOffset),
            wire::load_u8(item.data, kUtcDayOffset),
            wire::load_u8(item.data, kUtcHourOffset),
            wire::load_u8(item.data, kUtcMinuteOffset),
            wire::load_u8(item.data, kUtcSecondOffset),
            wire::load_u8(item.data, kUtcFlagsOffset)};
  m_.add(MtItem::utc_time);
}

void ItemDecoder::gnss_pvt(const RawItem& item) noexcept {
  if (item.data.size() != GnssPvt::kSize) return;  // another firmware's
  m_.gnss_pvt = load_gnss_pvt(item.data);
  m_.add(MtItem::gnss_pvt);
}

}  // namespace

double load_real(wire::Bytes data, std::size_t offset, NumberFormat format) noexcept {
  switch (format) {
    case NumberFormat::fp12_20:
      return wire::load_be<std::int32_t>(data, offset) * 0x1p-20;
    case NumberFormat::fp16_32:
      return wire::load_be<std::int16_t>(data, offset + kIntegerOffset) +
             wire::load_be<std::uint32_t>(data, offset + kFractionOffset) * 0x1p-32;
    case NumberFormat::float64:
      return std::bit_cast<double>(wire::load_be<std::uint64_t>(data, offset));
    case NumberFormat::float32:
      break;
  }
  return static_cast<double>(std::bit_cast<float>(wire::load_be<std::uint32_t>(data, offset)));
}

PayloadStatus parse_mtdata2(wire::Bytes payload, MtMeasurement& measurement) noexcept {
  measurement = MtMeasurement{};
  ItemDecoder decoder(measurement);
  const bool whole =
      for_each_item(payload, [&](const RawItem& item) noexcept { decoder.decode(item); });
  if (whole && decoder.all_sizes_right()) return PayloadStatus::ok;
  measurement = MtMeasurement{};
  return whole ? PayloadStatus::wrong_size : PayloadStatus::truncated;
}

}  // namespace convexcut::xsens
