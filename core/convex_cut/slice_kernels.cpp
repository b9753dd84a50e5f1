// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/slice_kernels.hpp"

#include <bit>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
// Highway includes this file again for each instruction set.
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define HWY_TARGET_INCLUDE "core/convex_cut/slice_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Behind foreach_target.h.
#include "core/simd/kernel_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace convexcut::HWY_NAMESPACE {

// v and u in float are off by less than this part of the extent: two products of rounded factors
// and their sum, 4.3·2⁻²⁴; and half_width_m is rounded too.
constexpr float kOffsetErrorPerExtent = 4e-7F;

constexpr float kFarAway = std::numeric_limits<float>::max();

// The lanes whose |v| is nearer to half_width_m than float can tell: the reference's expression.
HWY_NOINLINE std::uint64_t decide_exactly(const CloudView& sorted, std::size_t begin,
                                          std::uint64_t inside, std::uint64_t undecided,
                                          const SlicingPlane& plane, double half_width_m) noexcept {
  for (; undecided != 0; undecided &= undecided - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(undecided));
    const double v = plane.offset(sorted.x[begin + lane], sorted.y[begin + lane]);
    const std::uint64_t bit = std::uint64_t{1} << lane;
    inside = std::abs(v) < half_width_m ? inside | bit : inside & ~bit;
  }
  return inside;
}

std::size_t gather(const CloudView& sorted, std::span<const std::uint8_t> marks,
                   std::span<const ShellIndex::Candidates> candidates, const SlicingPlane& plane,
                   double half_width_m, float extent_m, const SliceColumns members,
                   Stretch* stretches) {
  const Floats df;
  const Words dw;
  const hn::Rebind<std::uint8_t, Words> db;
  const std::size_t lanes = hn::Lanes(df);
  const auto d = static_cast<float>(half_width_m);
  const float error = kOffsetErrorPerExtent * extent_m + d * 1e-7F;
  const Float cosine = hn::Set(df, static_cast<float>(plane.cos_theta));
  const Float sine = hn::Set(df, static_cast<float>(plane.sin_theta));
  const Float width = hn::Set(df, d);
  const Float least_doubt = hn::Set(df, error);
  const Word lane_numbers = hn::Iota(dw, 0);
  const float* HWY_RESTRICT xs = sorted.x.data();
  const float* HWY_RESTRICT ys = sorted.y.data();
  const float* HWY_RESTRICT zs = sorted.z.data();
  std::size_t count = 0;
  for (const auto& [range, least_u_m, most_u_m] : candidates) {
    const std::size_t begin = count;
    for (std::size_t i = range.begin; i < range.end; i += lanes) {
      const Float x = hn::LoadU(df, xs + i);
      const Float y = hn::LoadU(df, ys + i);
      const Float v = hn::Sub(hn::Mul(y, cosine), hn::Mul(x, sine));
      const Float beyond = hn::Sub(hn::Abs(v), width);
      const Mask present = hn::FirstN(df, range.end - i);
      Mask inside = hn::And(hn::Lt(beyond, hn::Zero(df)), present);
      const Mask doubtful = hn::And(hn::Le(hn::Abs(beyond), least_doubt), present);
      if (HWY_UNLIKELY(!hn::AllFalse(df, doubtful))) {
        inside = from_bits(
            decide_exactly(sorted, i, to_bits(inside), to_bits(doubtful), plane, half_width_m));
      }
      const Float u = hn::MulAdd(x, cosine, hn::Mul(y, sine));
      const Word mark = hn::ShiftLeft<31>(hn::PromoteTo(dw, hn::LoadU(db, marks.data() + i)));
      const Word position =
          hn::Or(hn::Add(lane_numbers, hn::Set(dw, static_cast<std::uint32_t>(i))), mark);
      const Compressor compress(inside);
      hn::StoreU(compress(u), df, members.u + count);
      hn::StoreU(compress(hn::LoadU(df, zs + i)), df, members.z + count);
      hn::StoreU(compress(position), dw, members.position + count);
      count += hn::CountTrue(df, inside);
    }
    *stretches++ = {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(count), least_u_m,
                    most_u_m};
  }
  return count;
}

// The axes on which extremes are looked for, counter-clockwise from u; each gives a greatest and a
// least point. Those that lean a little from u and z find the outermost noise at both ends of
// walls, floor and ceiling: the polygon then hugs them, and few points are left outside of it.
constexpr std::size_t kAxes = kExtremes / 2;
HWY_INLINE void along_axes(Float u, Float z, Float* HWY_RESTRICT values) noexcept {
  const Float lean = hn::Set(Floats(), 1.0F / 16.0F);
  const Float some_u = hn::Mul(u, lean);
  const Float some_z = hn::Mul(z, lean);
  values[0] = u;
  values[1] = hn::Add(u, some_z);
  values[2] = hn::Add(u, z);
  values[3] = hn::Add(some_u, z);
  values[4] = z;
  values[5] = hn::Sub(z, some_u);
  values[6] = hn::Sub(z, u);
  values[7] = hn::Sub(some_z, u);
}

// The vectors of members are numbered: a value is tagged with its vector's number. When there are
// more than this, only one in so many is looked at: what is left outside for it takes less than
// looking. Single members on the baseline path would take half of its time.
constexpr std::size_t kMostVectors = HWY_TARGET == HWY_SCALAR ? 1U << 7U : 1U << 9U;

// The member that the best of the lanes' tagged values names.
HWY_INLINE std::uint32_t tagged_member(Float tagged_values, Float best, std::uint32_t tag_mask,
                                       std::size_t step, std::size_t count) noexcept {
  const Floats df;
  const Words dw;
  const auto lane = static_cast<std::size_t>(hn::FindFirstTrue(df, hn::Eq(tagged_values, best)));
  const Word tag = hn::And(hn::BitCast(dw, best), hn::Set(dw, tag_mask));
  const std::size_t index = hn::GetLane(tag) * step + lane;
  return static_cast<std::uint32_t>(index < count ? index : count - 1);
}

Extremes extremes(const SliceColumns members, std::size_t count) {
  const Floats df;
  const Words dw;
  const std::size_t lanes = hn::Lanes(df);
  // Behind the end, the last member again: a vector holds members only.
  hn::StoreU(hn::Set(df, members.u[count - 1]), df, members.u + count);
  hn::StoreU(hn::Set(df, members.z[count - 1]), df, members.z + count);
  const std::size_t step = lanes * (count / lanes / kMostVectors + 1);
  const auto tag_mask = static_cast<std::uint32_t>(std::bit_ceil((count + step - 1) / step) - 1);

  const Word keep = hn::Set(dw, ~tag_mask);
  Float most[kAxes];
  Float least[kAxes];
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    most[axis] = hn::Set(df, -kFarAway);
    least[axis] = hn::Set(df, kFarAway);
  }
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < count; i += step, ++number) {
    const Float u = hn::LoadU(df, members.u + i);
    const Float z = hn::LoadU(df, members.z + i);
    const Word tag = hn::Set(dw, number);
    Float values[kAxes];
    along_axes(u, z, values);
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const Float numbered = tagged(values[axis], tag, keep);
      most[axis] = most_of(most[axis], numbered);
      least[axis] = least_of(least[axis], numbered);
    }
  }
  Extremes found{};
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    found[axis] = tagged_member(most[axis], hn::MaxOfLanes(df, most[axis]), tag_mask, step, count);
    found[axis + kAxes] =
        tagged_member(least[axis], hn::MinOfLanes(df, least[axis]), tag_mask, step, count);
  }
  return found;
}

}  // namespace convexcut::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace convexcut {

// Highway's table takes no noexcept functions; none of them throws.
HWY_EXPORT(gather);
HWY_EXPORT(extremes);

std::size_t gather(const CloudView& sorted, std::span<const std::uint8_t> marks,
                   std::span<const ShellIndex::Candidates> candidates, const SlicingPlane& plane,
                   double half_width_m, float extent_m, const SliceColumns& members,
                   Stretch* stretches) noexcept {
  return HWY_DYNAMIC_DISPATCH(gather)(sorted, marks, candidates, plane, half_width_m, extent_m,
                                      members, stretches);
}

Extremes extremes(const SliceColumns& members, std::size_t count) noexcept {
  return HWY_DYNAMIC_DISPATCH(extremes)(members, count);
}

}  // namespace convexcut
#endif
