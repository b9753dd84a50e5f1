// SPDX-License-Identifier: Apache-2.0
//
// The payload of an MTData2 message (0x36): items of
//
//   | data id u16 | size u8 | data[size] |
//
// in any order and any selection. Big-endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "drivers/wire.hpp"
#include "drivers/xsens/mt_measurement.hpp"

namespace convexcut::xsens {

inline constexpr std::size_t kItemIdOffset = 0;
inline constexpr std::size_t kItemSizeOffset = 2;
inline constexpr std::size_t kItemDataOffset = 3;
static_assert(kItemIdOffset + sizeof(std::uint16_t) == kItemSizeOffset);
static_assert(kItemSizeOffset + sizeof(std::uint8_t) == kItemDataOffset);

enum class PayloadStatus : std::uint8_t {
  ok,
  truncated,   // the last item says that it is longer than what is left
  wrong_size,  // a known item has not the size that its number format demands
};

struct RawItem {
  std::uint16_t data_id = 0;
  wire::Bytes data;
};

// Calls visit(RawItem) for each item up to the first that does not fit; says whether all did. RT.
template <class Visit>
[[nodiscard]] bool for_each_item(wire::Bytes payload, Visit&& visit) noexcept(
    std::is_nothrow_invocable_v<Visit&, const RawItem&>) {
  while (!payload.empty()) {
    if (payload.size() < kItemDataOffset) return false;
    const std::size_t size = wire::load_u8(payload, kItemSizeOffset);
    if (payload.size() - kItemDataOffset < size) return false;
    visit(RawItem{wire::load_be<std::uint16_t>(payload, kItemIdOffset),
                  payload.subspan(kItemDataOffset, size)});
    payload = payload.subspan(kItemDataOffset + size);
  }
  return true;
}

// Fills `measurement` with what the payload holds. Items with unknown ids, reserved formats or (for
// GNSS data) sizes of other firmwares are skipped by their size. A payload is taken as a whole or
// not at all: unless the status is ok, `measurement` is empty. RT: no allocation, no lock.
[[nodiscard]] PayloadStatus parse_mtdata2(wire::Bytes payload, MtMeasurement& measurement) noexcept;

// One number at `offset` of `data`, which the caller has checked. RT.
[[nodiscard]] double load_real(wire::Bytes data, std::size_t offset, NumberFormat format) noexcept;

}  // namespace convexcut::xsens
