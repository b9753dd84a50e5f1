// SPDX-License-Identifier: Apache-2.0
//
// The one layout of our sensor_msgs/PointCloud2: 24 bytes a point, every field naturally aligned,
// the same for all scans and both cloud topics (docs/design/dds.md has the reasons).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace convexcut::daemon {

// sensor_msgs/msg/PointField: FLOAT32 and so on.
enum class PointDatatype : std::uint8_t { uint8 = 2, uint16 = 4, uint32 = 6, float32 = 7 };

// As on the wire, in the host's byte order (the message says which that is).
struct WirePoint {
  float x, y, z;  // frame level, metres
  float intensity;
  std::uint32_t t;     // ns after header.stamp, ≥ 0
  std::uint16_t ring;  // 0 = lowest beam
  std::uint8_t label;  // convexcut::Label
  std::uint8_t padding;
};

struct PointFieldLayout {
  const char* name;
  std::uint32_t offset;
  PointDatatype datatype;
};

inline constexpr std::uint32_t kPointStep = 24;
inline constexpr std::array<PointFieldLayout, 7> kPointFields{{
    {"x", 0, PointDatatype::float32},
    {"y", 4, PointDatatype::float32},
    {"z", 8, PointDatatype::float32},
    {"intensity", 12, PointDatatype::float32},
    {"t", 16, PointDatatype::uint32},
    {"ring", 20, PointDatatype::uint16},
    {"label", 22, PointDatatype::uint8},
}};

static_assert(sizeof(WirePoint) == kPointStep);
static_assert(offsetof(WirePoint, x) == kPointFields[0].offset);
static_assert(offsetof(WirePoint, y) == kPointFields[1].offset);
static_assert(offsetof(WirePoint, z) == kPointFields[2].offset);
static_assert(offsetof(WirePoint, intensity) == kPointFields[3].offset);
static_assert(offsetof(WirePoint, t) == kPointFields[4].offset);
static_assert(offsetof(WirePoint, ring) == kPointFields[5].offset);
static_assert(offsetof(WirePoint, label) == kPointFields[6].offset);

}  // namespace convexcut::daemon
