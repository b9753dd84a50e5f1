// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/block_kernels.hpp"

#include <bit>
#include <numbers>

#include "core/angle.hpp"
#include "drivers/velodyne/sin_cos.hpp"

#undef HWY_TARGET_INCLUDE
// Highway includes this file again for each instruction set.
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define HWY_TARGET_INCLUDE "drivers/velodyne/block_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Behind foreach_target.h.
#include "core/simd/kernel_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace convexcut::velodyne::HWY_NAMESPACE {
using namespace convexcut::HWY_NAMESPACE;  // NOLINT(google-build-using-namespace): the kernels' own

using Doubles = hn::ScalableTag<double>;
using Double = hn::Vec<Doubles>;

constexpr std::size_t kReturns = wire_layout::kReturnsPerBlock;

// The three bytes of each return into columns.
HWY_INLINE void unpack(wire::Bytes block, BlockReturns& out) noexcept {
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t i = 0; i < kReturns; ++i) {
    const std::size_t at = wire_layout::kBlockReturns + i * wire_layout::kReturnSize;
    out.ticks[i] = wire::load_le<std::uint16_t>(block, at + wire_layout::kReturnDistance);
    out.intensity[i] = wire::load_u8(block, at + wire_layout::kReturnIntensity);
  }
#else
  const hn::FixedTag<std::uint8_t, 16> bytes;
  const hn::Repartition<std::uint16_t, decltype(bytes)> shorts;
  static_assert(wire_layout::kReturnSize == 3 && wire_layout::kReturnIntensity == 2);
  const auto* from =
      reinterpret_cast<const std::uint8_t*>(block.data()) + wire_layout::kBlockReturns;
  for (std::size_t i = 0; i < kReturns; i += 16) {
    hn::Vec<decltype(bytes)> low;
    hn::Vec<decltype(bytes)> high;
    hn::Vec<decltype(bytes)> intensity;
    hn::LoadInterleaved3(bytes, from + i * wire_layout::kReturnSize, low, high, intensity);
    hn::Store(hn::BitCast(shorts, hn::InterleaveLower(bytes, low, high)), shorts,
              out.ticks.data() + i);
    hn::Store(hn::BitCast(shorts, hn::InterleaveUpper(bytes, low, high)), shorts,
              out.ticks.data() + i + 8);
    hn::Store(intensity, bytes, out.intensity.data() + i);
  }
#endif
}

struct Direction {
  Double sin;
  Double cos;
};

// The whole degrees of kWholeDegrees; most often the same for all lanes.
HWY_INLINE Direction whole_degrees(Double degrees) noexcept {
  const Doubles dd;
  const hn::RebindToSigned<Doubles> di;
  static_assert(sizeof(SinCos) == 2 * sizeof(double));
  const double first = hn::GetLane(degrees);
  if (HWY_LIKELY(hn::AllTrue(dd, hn::Eq(degrees, hn::Set(dd, first))))) {
    const SinCos& entry = detail::kWholeDegrees[static_cast<std::size_t>(first)];
    return {hn::Set(dd, entry.sin), hn::Set(dd, entry.cos)};
  }
  const auto index = hn::ConvertTo(di, hn::Add(degrees, degrees));
  return {hn::GatherIndex(dd, &detail::kWholeDegrees[0].sin, index),
          hn::GatherIndex(dd, &detail::kWholeDegrees[0].cos, index)};
}

// sin_cos() of several azimuths at once, operation by operation; whole microdegrees of one turn.
HWY_INLINE Direction sin_cos_of(Double azimuth_udeg) noexcept {
  const Doubles dd;
  constexpr double kDegree = 1e6;
  // Half a microdegree more than half a degree: no azimuth is near enough to a tie for the
  // reciprocal's error to matter.
  const Double nearest = hn::Floor(
      hn::Mul(hn::Add(azimuth_udeg, hn::Set(dd, kDegree / 2 + 0.5)), hn::Set(dd, 1.0 / kDegree)));
  const Double rest = hn::Mul(hn::Sub(azimuth_udeg, hn::Mul(nearest, hn::Set(dd, kDegree))),
                              hn::Set(dd, std::numbers::pi / 180.0 / kDegree));
  const Double rest2 = hn::Mul(rest, rest);
  const Double sin = hn::Sub(rest, hn::Mul(hn::Mul(rest, rest2), hn::Set(dd, 1.0 / 6.0)));
  const Double cos = hn::Add(hn::Sub(hn::Set(dd, 1.0), hn::Mul(rest2, hn::Set(dd, 0.5))),
                             hn::Mul(hn::Mul(rest2, rest2), hn::Set(dd, 1.0 / 24.0)));
  const Direction base = whole_degrees(nearest);
  return {hn::Add(hn::Mul(base.sin, cos), hn::Mul(base.cos, sin)),
          hn::Sub(hn::Mul(base.cos, cos), hn::Mul(base.sin, sin))};
}

// Of each laser at its own time, reduced to one turn.
HWY_INLINE Double azimuths_at(const SlotTable& slots, std::size_t i,
                              const BlockSweep& sweep) noexcept {
  const Doubles dd;
  const Double full_turn = hn::Set(dd, static_cast<double>(Azimuth::kFullTurn));
  // Exact up to Floor: the share has 32 binary digits and the step 21.
  const Double turned =
      hn::Floor(hn::Add(hn::Mul(hn::Set(dd, sweep.step_udeg), hn::Load(dd, &slots.block_share[i])),
                        hn::Set(dd, 0.5)));
  const Double azimuth = hn::Add(hn::Add(hn::Set(dd, sweep.azimuth_udeg), turned),
                                 hn::Load(dd, &slots.azimuth_offset_udeg[i]));
  const Double below =
      hn::IfThenElse(hn::Ge(azimuth, full_turn), hn::Sub(azimuth, full_turn), azimuth);
  return hn::IfThenElse(hn::Lt(below, hn::Zero(dd)), hn::Add(below, full_turn), below);
}

void locate(const SlotTable& slots, const BlockSweep& sweep, wire::Bytes block, BlockReturns& out) {
  const Doubles dd;
  const hn::Rebind<float, Doubles> df;
  const hn::Rebind<std::int32_t, Doubles> di;
  const hn::Rebind<std::uint16_t, Doubles> dt;
  unpack(block, out);
  const Double unit = hn::Set(dd, slots.metres_per_tick);
  for (std::size_t i = 0; i < kReturns; i += hn::Lanes(dd)) {
    const Direction azimuth = sin_cos_of(azimuths_at(slots, i, sweep));
    const Double flat = hn::Load(dd, &slots.cos_elevation[i]);
    const auto ticks = hn::PromoteTo(di, hn::Load(dt, &out.ticks[i]));
    const Double range = hn::Mul(hn::PromoteTo(dd, ticks), unit);
    const Double x = hn::Mul(range, hn::Mul(flat, azimuth.cos));
    const Double y = hn::Mul(range, hn::Neg(hn::Mul(flat, azimuth.sin)));
    const Double z = hn::Add(hn::Mul(range, hn::Load(dd, &slots.sin_elevation[i])),
                             hn::Load(dd, &slots.vertical_offset_m[i]));
    hn::Store(hn::DemoteTo(df, x), df, &out.x_lidar[i]);
    hn::Store(hn::DemoteTo(df, y), df, &out.y_lidar[i]);
    hn::Store(hn::DemoteTo(df, z), df, &out.z_lidar[i]);
    hn::Store(hn::DemoteTo(df, range), df, &out.range_m[i]);
  }
}

std::uint32_t append_echoes(const SlotTable& slots, const BlockReturns& block,
                            std::uint32_t start_ns, ReturnBatch& batch) {
  const Floats df;
  const Words dw;
  const hn::Rebind<std::uint8_t, Words> db;
  const Word start = hn::Set(dw, start_ns);
  std::size_t end = batch.return_count;
  std::uint32_t echoes = 0;
  for (std::size_t i = 0; i < kReturns; i += hn::Lanes(df)) {
    const auto range = hn::Load(df, &block.range_m[i]);
    const auto present = hn::Ne(range, hn::Zero(df));
    const Compressor compress(present);
    const auto intensity = hn::PromoteTo(dw, hn::Load(db, &block.intensity[i]));
    hn::StoreU(compress(hn::Load(df, &block.x_lidar[i])), df, &batch.x_lidar[end]);
    hn::StoreU(compress(hn::Load(df, &block.y_lidar[i])), df, &batch.y_lidar[end]);
    hn::StoreU(compress(hn::Load(df, &block.z_lidar[i])), df, &batch.z_lidar[end]);
    hn::StoreU(compress(range), df, &batch.range_m[end]);
    hn::StoreU(compress(hn::Add(start, hn::Load(dw, &slots.time_ns[i]))), dw,
               &batch.offset_ns[end]);
    hn::StoreU(hn::U8FromU32(compress(intensity)), db, &batch.intensity[end]);
    hn::StoreU(hn::U8FromU32(compress(hn::Load(dw, &slots.ring[i]))), db, &batch.ring[end]);
    const auto bits = static_cast<std::uint32_t>(to_bits(present));
    echoes |= bits << i;
    end += static_cast<std::size_t>(std::popcount(bits));
  }
  batch.return_count = static_cast<std::uint16_t>(end);
  return echoes;
}

}  // namespace convexcut::velodyne::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace convexcut::velodyne {

// Highway's table takes no noexcept functions; none of them throws.
HWY_EXPORT(locate);
HWY_EXPORT(append_echoes);

void locate(const SlotTable& slots, const BlockSweep& sweep, wire::Bytes block,
            BlockReturns& out) noexcept {
  HWY_DYNAMIC_DISPATCH(locate)(slots, sweep, block, out);
}

std::uint32_t append_echoes(const SlotTable& slots, const BlockReturns& block,
                            std::uint32_t start_ns, ReturnBatch& batch) noexcept {
  return HWY_DYNAMIC_DISPATCH(append_echoes)(slots, block, start_ns, batch);
}

}  // namespace convexcut::velodyne
#endif
