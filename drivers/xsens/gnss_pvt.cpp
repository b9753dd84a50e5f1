// SPDX-License-Identifier: Apache-2.0
#include "drivers/xsens/gnss_pvt.hpp"

#include <concepts>

namespace convexcut::xsens {
namespace {

// Reads big-endian fields one after the other: the layout is the order of the struct, unpadded.
class FieldReader {
 public:
  explicit FieldReader(wire::Bytes data) noexcept : data_(data) {}
  template <std::integral... Field>
  void read(Field&... fields) noexcept {
    (read_one(fields), ...);
  }

 private:
  template <std::integral Field>
  void read_one(Field& field) noexcept {
    field = wire::load_be<Field>(data_, offset_);
    offset_ += sizeof(Field);
  }
  wire::Bytes data_;
  std::size_t offset_ = 0;
};

constexpr std::size_t kTimeBlock = 4 + 2 + 6 + 4 + 4;
constexpr std::size_t kFixBlock = 4;
constexpr std::size_t kPositionBlock = 6UL * 4;
constexpr std::size_t kVelocityBlock = 8UL * 4;
constexpr std::size_t kDilutionBlock = 7UL * 2;
static_assert(kTimeBlock + kFixBlock + kPositionBlock + kVelocityBlock + kDilutionBlock ==
              GnssPvt::kSize);

}  // namespace

GnssPvt load_gnss_pvt(wire::Bytes data) noexcept {
  GnssPvt p;
  FieldReader reader(data);
  reader.read(p.itow_ms, p.year, p.month, p.day, p.hour, p.minute, p.second, p.valid);
  reader.read(p.time_accuracy_ns, p.nanosecond);
  reader.read(p.fix_type, p.flags, p.satellites, p.reserved);
  reader.read(p.longitude_1e7_deg, p.latitude_1e7_deg, p.height_ellipsoid_mm, p.height_msl_mm);
  reader.read(p.horizontal_accuracy_mm, p.vertical_accuracy_mm);
  reader.read(p.velocity_north_mm_s, p.velocity_east_mm_s, p.velocity_down_mm_s);
  reader.read(p.ground_speed_mm_s, p.heading_of_motion_1e5_deg, p.speed_accuracy_mm_s);
  reader.read(p.heading_accuracy_1e5_deg, p.heading_of_vehicle_1e5_deg);
  reader.read(p.gdop, p.pdop, p.tdop, p.vdop, p.hdop, p.ndop, p.edop);
  return p;
}

}  // namespace convexcut::xsens
