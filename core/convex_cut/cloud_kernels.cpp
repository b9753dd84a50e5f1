// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/cloud_kernels.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "core/convex_cut/direction.hpp"
#include "core/convex_cut/shell_index.hpp"

#undef HWY_TARGET_INCLUDE
// Highway includes this file again for each instruction set.
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define HWY_TARGET_INCLUDE "core/convex_cut/cloud_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Behind foreach_target.h.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace convexcut::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::ScalableTag<std::int32_t>;
using Float = hn::Vec<Floats>;
using Int = hn::Vec<Ints>;

constexpr std::uint32_t kWithoutSign = 0x7FFF'FFFF;

std::uint32_t greatest_magnitude_bits(std::span<const float> values) {
  const Ints di;
  const Floats df;
  const std::size_t lanes = hn::Lanes(df);
  const Int without_sign = hn::Set(di, static_cast<std::int32_t>(kWithoutSign));
  Int greatest = hn::Zero(di);
  std::size_t i = 0;
  for (; i + lanes <= values.size(); i += lanes) {
    const Int bits = hn::BitCast(di, hn::LoadU(df, values.data() + i));
    greatest = hn::Max(greatest, hn::And(bits, without_sign));
  }
  auto result = static_cast<std::uint32_t>(hn::GetLane(hn::MaxOfLanes(di, greatest)));
  for (; i < values.size(); ++i) {
    result = std::max(result, std::bit_cast<std::uint32_t>(values[i]) & kWithoutSign);
  }
  return result;
}

// direction() of eight or so points at once.
HWY_INLINE Float direction_of(Float x, Float y) noexcept {
  const Floats df;
  const Float along = hn::Xor(x, hn::And(y, hn::SignBit(df)));
  const Float width = hn::Abs(x);
  const Float height = hn::Abs(y);
  const Float longer = hn::Max(width, height);
  const Float shorter = hn::Min(width, height);
  const Float tangent = hn::Div(shorter, hn::Add(longer, hn::Set(df, kNoLength<float>)));
  const Float one = hn::Set(df, 1.0F);
  const Float bend = hn::Set(df, kBend<float>);
  const Float eighth = hn::Mul(tangent, hn::MulAdd(bend, hn::Sub(one, tangent), one));
  const Float quarter =
      hn::IfThenElse(hn::Gt(width, height), eighth, hn::Sub(hn::Set(df, 2.0F), eighth));
  const Float half = hn::IfThenElse(hn::Lt(along, hn::Zero(df)),
                                    hn::Sub(hn::Set(df, kHalfTurn<float>), quarter), quarter);
  const auto below = hn::MaskFromVec(hn::BitCast(df, hn::BroadcastSignBit(hn::BitCast(Ints(), y))));
  return hn::IfThenElse(below, hn::Add(half, hn::Set(df, kHalfTurn<float>)), half);
}

HWY_INLINE Int keys_of(Float x, Float y, Float inverse_squared_half_width) noexcept {
  constexpr int kExponentShift = 23;
  constexpr std::int32_t kExponentBias = 127;
  const Ints di;
  const Floats df;
  // (r/d)² in [2ˢ, 2ˢ⁺¹) has the exponent s.
  const Float ratio = hn::Mul(hn::MulAdd(x, x, hn::Mul(y, y)), inverse_squared_half_width);
  const Int exponent =
      hn::Sub(hn::ShiftRight<kExponentShift>(hn::BitCast(di, ratio)), hn::Set(di, kExponentBias));
  constexpr auto kLastShell = static_cast<std::int32_t>(ShellIndex::kShells - 1);
  constexpr auto kLastBucket = static_cast<std::int32_t>(ShellIndex::kBuckets - 1);
  const Int shell = hn::Min(hn::Max(exponent, hn::Zero(di)), hn::Set(di, kLastShell));
  const Float turn = hn::Mul(direction_of(x, y),
                             hn::Set(df, static_cast<float>(ShellIndex::kBuckets) / kTurn<float>));
  const Int bucket = hn::Min(hn::ConvertTo(di, turn), hn::Set(di, kLastBucket));
  constexpr int kBucketBits = std::countr_zero(ShellIndex::kBuckets);
  return hn::Add(hn::ShiftLeft<kBucketBits>(shell), bucket);
}

KeyBounds shell_keys(const CloudView& cloud, std::size_t begin, std::size_t end,
                     float inverse_squared_half_width, std::uint16_t* keys) {
  const Floats df;
  const Ints di;
  const hn::Rebind<std::uint16_t, Floats> dk;
  const std::size_t lanes = hn::Lanes(df);
  const Float inverse = hn::Set(df, inverse_squared_half_width);
  const Int without_sign = hn::Set(di, static_cast<std::int32_t>(kWithoutSign));
  Int least = hn::Set(di, 0xFFFF);
  Int greatest = hn::Zero(di);
  Int magnitude = hn::Zero(di);
  const auto keys_at = [&](const float* x, const float* y, const float* z) HWY_ATTR {
    const Float at_x = hn::LoadU(df, x);
    const Float at_y = hn::LoadU(df, y);
    const Int key = keys_of(at_x, at_y, inverse);
    least = hn::Min(least, key);
    greatest = hn::Max(greatest, key);
    const Int z_bits = hn::And(hn::BitCast(di, hn::LoadU(df, z)), without_sign);
    const Int x_bits = hn::And(hn::BitCast(di, at_x), without_sign);
    const Int y_bits = hn::And(hn::BitCast(di, at_y), without_sign);
    magnitude = hn::Max(hn::Max(magnitude, z_bits), hn::Max(x_bits, y_bits));
    return hn::DemoteTo(dk, key);
  };
  std::size_t i = begin;
  for (; i + lanes <= end; i += lanes) {
    hn::StoreU(keys_at(cloud.x.data() + i, cloud.y.data() + i, cloud.z.data() + i), dk, keys + i);
  }
  HWY_ALIGN float x[hn::MaxLanes(df)] = {};
  HWY_ALIGN float y[hn::MaxLanes(df)] = {};
  HWY_ALIGN float z[hn::MaxLanes(df)] = {};
  if (i < end) {
    for (std::size_t k = 0; k < lanes; ++k) {  // behind the end, the last point again
      x[k] = cloud.x[std::min(i + k, end - 1)];
      y[k] = cloud.y[std::min(i + k, end - 1)];
      z[k] = cloud.z[std::min(i + k, end - 1)];
    }
    HWY_ALIGN std::uint16_t last[hn::MaxLanes(df)];
    hn::StoreU(keys_at(x, y, z), dk, last);
    std::copy_n(last, end - i, keys + i);
  }
  return {static_cast<std::uint16_t>(hn::GetLane(hn::MinOfLanes(di, least))),
          static_cast<std::uint16_t>(hn::GetLane(hn::MaxOfLanes(di, greatest))),
          static_cast<std::uint32_t>(hn::GetLane(hn::MaxOfLanes(di, magnitude)))};
}

void place_points(const CloudView& cloud, const std::uint16_t* keys, const std::uint32_t* ranks,
                  std::size_t begin, std::size_t end, const std::uint32_t* starts,
                  PointRecord* records) {
  const hn::CappedTag<float, 4> df;
  const hn::RebindToUnsigned<decltype(df)> dw;
  const std::size_t lanes = hn::Lanes(df);
  const float* HWY_RESTRICT xs = cloud.x.data();
  const float* HWY_RESTRICT ys = cloud.y.data();
  const float* HWY_RESTRICT zs = cloud.z.data();
  std::size_t i = begin;
  for (; i + lanes <= end; i += lanes) {
    alignas(16) std::array<PointRecord, hn::MaxLanes(df)> turned;
    const auto source = hn::Iota(dw, static_cast<std::uint32_t>(i));
    hn::StoreInterleaved4(hn::LoadU(df, xs + i), hn::LoadU(df, ys + i), hn::LoadU(df, zs + i),
                          hn::BitCast(df, source), df, &turned[0].x);
    for (std::size_t k = 0; k < lanes; ++k) records[starts[keys[i + k]] + ranks[i + k]] = turned[k];
  }
  for (; i < end; ++i) {
    records[starts[keys[i]] + ranks[i]] = {xs[i], ys[i], zs[i], static_cast<std::uint32_t>(i)};
  }
}

void spread_records(const PointRecord* records, std::size_t begin, std::size_t end,
                    const PointColumns columns, bool past_the_cache) {
  const Floats df;
  const hn::ScalableTag<std::uint32_t> dw;
  for (std::size_t i = begin; i < end; i += hn::Lanes(df)) {
    Float x;
    Float y;
    Float z;
    Float source;
    hn::LoadInterleaved4(df, &records[i].x, x, y, z, source);
    if (past_the_cache) {
      hn::Stream(x, df, columns.x + i);
      hn::Stream(y, df, columns.y + i);
      hn::Stream(z, df, columns.z + i);
      hn::Stream(hn::BitCast(dw, source), dw, columns.source + i);
    } else {
      hn::StoreU(x, df, columns.x + i);
      hn::StoreU(y, df, columns.y + i);
      hn::StoreU(z, df, columns.z + i);
      hn::StoreU(hn::BitCast(dw, source), dw, columns.source + i);
    }
  }
  if (past_the_cache) hwy::FlushStream();
}

}  // namespace convexcut::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace convexcut {

// Highway's table takes no noexcept functions; none of them throws.
HWY_EXPORT(greatest_magnitude_bits);
HWY_EXPORT(shell_keys);
HWY_EXPORT(place_points);
HWY_EXPORT(spread_records);

std::uint32_t greatest_magnitude_bits(std::span<const float> values) noexcept {
  return HWY_DYNAMIC_DISPATCH(greatest_magnitude_bits)(values);
}

KeyBounds shell_keys(const CloudView& cloud, std::size_t begin, std::size_t end,
                     float inverse_squared_half_width, std::uint16_t* keys) noexcept {
  return HWY_DYNAMIC_DISPATCH(shell_keys)(cloud, begin, end, inverse_squared_half_width, keys);
}

void place_points(const CloudView& cloud, const std::uint16_t* keys, const std::uint32_t* ranks,
                  std::size_t begin, std::size_t end, const std::uint32_t* starts,
                  PointRecord* records) noexcept {
  HWY_DYNAMIC_DISPATCH(place_points)(cloud, keys, ranks, begin, end, starts, records);
}

void spread_records(const PointRecord* records, std::size_t begin, std::size_t end,
                    const PointColumns& columns, bool past_the_cache) noexcept {
  HWY_DYNAMIC_DISPATCH(spread_records)(records, begin, end, columns, past_the_cache);
}

}  // namespace convexcut
#endif
