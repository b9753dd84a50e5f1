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
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace convexcut::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Words = hn::ScalableTag<std::uint32_t>;
using Float = hn::Vec<Floats>;
using Word = hn::Vec<Words>;
using Mask = hn::Mask<Floats>;

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

HWY_INLINE std::uint64_t to_bits(Mask mask) noexcept {
  std::uint64_t bits = 0;
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Floats(), mask, bytes);
  for (unsigned i = 8; i-- > 0;) bits = (bits << 8U) | bytes[i];
  return bits;
}

HWY_INLINE Mask from_bits(std::uint64_t bits) noexcept {
  std::uint8_t bytes[8];
  for (auto& byte : bytes) {
    byte = static_cast<std::uint8_t>(bits);
    bits >>= 8U;
  }
  return hn::LoadMaskBits(Floats(), bytes);
}

std::size_t gather(const CloudView& sorted, std::span<const std::uint8_t> marks,
                   std::span<const ShellIndex::Range> ranges, const SlicingPlane& plane,
                   double half_width_m, float extent_m, const SliceColumns& members) {
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
  for (const ShellIndex::Range range : ranges) {
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
      hn::StoreU(hn::Compress(u, inside), df, members.u + count);
      hn::StoreU(hn::Compress(hn::LoadU(df, zs + i), inside), df, members.z + count);
      hn::StoreU(hn::Compress(position, hn::RebindMask(dw, inside)), dw, members.position + count);
      count += hn::CountTrue(df, inside);
    }
  }
  return count;
}

// The axes on which extremes are looked for, counter-clockwise from u; each gives a greatest and a
// least point. Those that lean a little from u and z find the outermost noise at both ends of
// walls, floor and ceiling: the polygon then hugs them, and few points are left outside of it.
constexpr std::size_t kAxes = kExtremes / 2;
struct Axis {
  float u;
  float z;
};
constexpr float kLean = 1.0F / 16.0F;
constexpr std::array<Axis, kAxes> kCoarse{
    {{1, 0}, {1, kLean}, {1, 1}, {kLean, 1}, {0, 1}, {-kLean, 1}, {-1, 1}, {-1, kLean}}};
constexpr float kSlight = 1.0F / 32.0F;
constexpr float kStrong = 1.0F / 4.0F;
constexpr std::array<Axis, kAxes> kFine{{{1, kSlight},
                                         {1, kStrong},
                                         {kStrong, 1},
                                         {kSlight, 1},
                                         {-kSlight, 1},
                                         {-kStrong, 1},
                                         {-1, kStrong},
                                         {-1, kSlight}}};

// The number of a vector takes the place of a value's lowest mantissa bits, as few as are needed:
// one maximum finds both. That only makes the choice a little worse.
constexpr std::size_t kMostVectors = 1U << 11U;

// The member that the best of the lanes' tagged values names.
HWY_INLINE std::uint32_t tagged_member(Float tagged, Float best, std::uint32_t tag_mask,
                                       std::size_t step, std::size_t count) noexcept {
  const Floats df;
  const Words dw;
  const auto lane = static_cast<std::size_t>(hn::FindFirstTrue(df, hn::Eq(tagged, best)));
  const Word tag = hn::And(hn::BitCast(dw, best), hn::Set(dw, tag_mask));
  const std::size_t index = hn::GetLane(tag) * step + lane;
  return static_cast<std::uint32_t>(index < count ? index : count - 1);
}

Extremes extremes(const SliceColumns& members, std::size_t count, Directions directions) {
  const Floats df;
  const Words dw;
  const std::size_t lanes = hn::Lanes(df);
  // Behind the end, the last member again: a vector holds members only.
  hn::StoreU(hn::Set(df, members.u[count - 1]), df, members.u + count);
  hn::StoreU(hn::Set(df, members.z[count - 1]), df, members.z + count);
  const std::size_t step = lanes * (count / lanes / kMostVectors + 1);
  const auto tag_mask = static_cast<std::uint32_t>(std::bit_ceil((count + step - 1) / step) - 1);

  const std::array<Axis, kAxes>& axes = directions == Directions::coarse ? kCoarse : kFine;
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
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const Float value =
          hn::MulAdd(u, hn::Set(df, axes[axis].u), hn::Mul(z, hn::Set(df, axes[axis].z)));
      const Float tagged = hn::BitCast(df, hn::OrAnd(tag, hn::BitCast(dw, value), keep));
      most[axis] = hn::Max(most[axis], tagged);
      least[axis] = hn::Min(least[axis], tagged);
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

void set_edges(std::span<const HullPoint> polygon, EdgeColumns& edges) {
  using Doubles = hn::ScalableTag<double>;
  const Doubles dd;
  const hn::Rebind<float, Doubles> df;
  const std::size_t lanes = hn::Lanes(dd);
  HWY_ALIGN double u[hn::MaxLanes(dd) + 1];
  HWY_ALIGN double z[hn::MaxLanes(dd) + 1];
  const std::size_t size = polygon.size();
  // Edge k leads from vertex k − 1 to vertex k.
  u[0] = polygon.back().u;
  z[0] = polygon.back().z;
  for (std::size_t begin = 0; begin < size; begin += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) {
      const HullPoint& vertex = polygon[begin + k < size ? begin + k : size - 1];
      u[k + 1] = vertex.u;
      z[k + 1] = vertex.z;
    }
    const auto to_u = hn::LoadU(dd, u + 1);
    const auto to_z = hn::LoadU(dd, z + 1);
    const auto edge_u = hn::Sub(to_u, hn::Load(dd, u));
    const auto edge_z = hn::Sub(to_z, hn::Load(dd, z));
    const auto length = hn::Sqrt(hn::MulAdd(edge_u, edge_u, hn::Mul(edge_z, edge_z)));
    // Counter-clockwise: the inside is on the left.
    const auto normal_u = hn::Neg(hn::Div(edge_z, length));
    const auto normal_z = hn::Div(edge_u, length);
    const auto offset = hn::MulAdd(normal_u, to_u, hn::Mul(normal_z, to_z));
    hn::StoreU(hn::DemoteTo(df, normal_u), df, edges.normal_u + begin);
    hn::StoreU(hn::DemoteTo(df, normal_z), df, edges.normal_z + begin);
    hn::StoreU(hn::DemoteTo(df, offset), df, edges.offset + begin);
    u[0] = u[lanes];
    z[0] = z[lanes];
  }
  edges.count = size;
}

// Four vectors of members at once: an edge is loaded once for all of them.
struct Block {
  Float u0, u1, u2, u3;
  Float z0, z1, z2, z3;
  Float depth0, depth1, depth2, depth3;
};

HWY_INLINE Block load_with_depth(const EdgeColumns& edges, const SliceColumns& members,
                                 std::size_t i) noexcept {
  const Floats df;
  const std::size_t lanes = hn::Lanes(df);
  Block b;
  b.u0 = hn::LoadU(df, members.u + i);
  b.u1 = hn::LoadU(df, members.u + i + lanes);
  b.u2 = hn::LoadU(df, members.u + i + 2 * lanes);
  b.u3 = hn::LoadU(df, members.u + i + 3 * lanes);
  b.z0 = hn::LoadU(df, members.z + i);
  b.z1 = hn::LoadU(df, members.z + i + lanes);
  b.z2 = hn::LoadU(df, members.z + i + 2 * lanes);
  b.z3 = hn::LoadU(df, members.z + i + 3 * lanes);
  b.depth0 = hn::Set(df, kFarAway);
  b.depth1 = b.depth0;
  b.depth2 = b.depth0;
  b.depth3 = b.depth0;
  for (std::size_t k = 0; k < edges.count; ++k) {
    const Float normal_u = hn::Set(df, edges.normal_u[k]);
    const Float normal_z = hn::Set(df, edges.normal_z[k]);
    const Float offset = hn::Set(df, edges.offset[k]);
    const auto nearer = [&](Float depth, Float u, Float z) HWY_ATTR {
      return hn::Min(depth, hn::MulAdd(normal_u, u, hn::MulSub(normal_z, z, offset)));
    };
    b.depth0 = nearer(b.depth0, b.u0, b.z0);
    b.depth1 = nearer(b.depth1, b.u1, b.z1);
    b.depth2 = nearer(b.depth2, b.u2, b.z2);
    b.depth3 = nearer(b.depth3, b.u3, b.z3);
  }
  return b;
}

std::size_t depths(const EdgeColumns& edges, const SliceColumns& members, std::size_t count,
                   float limit_m, float* depth, const SliceColumns& shallow) {
  const Floats df;
  const Words dw;
  const std::size_t lanes = hn::Lanes(df);
  const Float limit = hn::Set(df, limit_m);
  const Word marked = hn::Set(dw, kMarked);
  std::size_t found = 0;
  for (std::size_t base = 0; base < count; base += 4 * lanes) {
    const Block b = load_with_depth(edges, members, base);
    const auto take = [&](std::size_t i, Float u, Float z, Float value) HWY_ATTR {
      hn::StoreU(value, df, depth + i);
      const Mask is_shallow =
          hn::And(hn::Le(value, limit), hn::FirstN(df, count > i ? count - i : 0));
      if (!hn::AllFalse(df, is_shallow)) {
        const Word position = hn::AndNot(marked, hn::LoadU(dw, members.position + i));
        hn::StoreU(hn::Compress(u, is_shallow), df, shallow.u + found);
        hn::StoreU(hn::Compress(z, is_shallow), df, shallow.z + found);
        hn::StoreU(hn::Compress(position, hn::RebindMask(dw, is_shallow)), dw,
                   shallow.position + found);
        found += hn::CountTrue(df, is_shallow);
      }
    };
    take(base, b.u0, b.z0, b.depth0);
    take(base + lanes, b.u1, b.z1, b.depth1);
    take(base + 2 * lanes, b.u2, b.z2, b.depth2);
    take(base + 3 * lanes, b.u3, b.z3, b.depth3);
  }
  return found;
}

std::size_t drop_deep(const float* depth, float limit_m, const SliceColumns& members,
                      std::size_t count) {
  const Floats df;
  const Words dw;
  const std::size_t lanes = hn::Lanes(df);
  const Float limit = hn::Set(df, limit_m);
  const Word marked = hn::Set(dw, kMarked);
  std::size_t left = 0;
  for (std::size_t i = 0; i < count; i += lanes) {
    const Word position = hn::LoadU(dw, members.position + i);
    const Mask shallow =
        hn::And(hn::Le(hn::LoadU(df, depth + i), limit), hn::FirstN(df, count - i));
    const Mask stays =
        hn::And(shallow, hn::RebindMask(df, hn::Eq(hn::And(position, marked), hn::Zero(dw))));
    hn::StoreU(hn::Compress(hn::LoadU(df, members.u + i), stays), df, members.u + left);
    hn::StoreU(hn::Compress(hn::LoadU(df, members.z + i), stays), df, members.z + left);
    hn::StoreU(hn::Compress(position, hn::RebindMask(dw, stays)), dw, members.position + left);
    left += hn::CountTrue(df, stays);
  }
  return left;
}

std::size_t mark_near(const EdgeColumns& edges, const SliceColumns& members, std::size_t count,
                      float e_m, float tolerance_m, std::span<std::uint8_t> marks) {
  const Floats df;
  const Words dw;
  const std::size_t lanes = hn::Lanes(df);
  const Float surely = hn::Set(df, e_m - tolerance_m);
  const Float possibly = hn::Set(df, e_m + tolerance_m);
  const Word marked = hn::Set(dw, kMarked);
  HWY_ALIGN std::uint32_t near[hn::MaxLanes(dw)];
  std::size_t doubtful_count = 0;
  for (std::size_t base = 0; base < count; base += 4 * lanes) {
    const Block b = load_with_depth(edges, members, base);
    const Word p0 = hn::LoadU(dw, members.position + base);
    const Word p1 = hn::LoadU(dw, members.position + base + lanes);
    const Word p2 = hn::LoadU(dw, members.position + base + 2 * lanes);
    const Word p3 = hn::LoadU(dw, members.position + base + 3 * lanes);
    const auto take = [&](std::size_t i, Word p, Float depth) HWY_ATTR {
      const Mask present = hn::FirstN(df, count > i ? count - i : 0);
      const Mask is_near = hn::And(hn::Lt(depth, surely), present);
      const Mask is_doubtful = hn::AndNot(is_near, hn::And(hn::Le(depth, possibly), present));
      const Word position = hn::AndNot(marked, p);
      hn::Store(hn::Compress(position, hn::RebindMask(dw, is_near)), dw, near);
      const std::size_t near_count = hn::CountTrue(df, is_near);
      for (std::size_t k = 0; k < near_count; ++k) marks[near[k]] = 1;
      if (HWY_UNLIKELY(!hn::AllFalse(df, is_doubtful))) {
        hn::StoreU(hn::Compress(position, hn::RebindMask(dw, is_doubtful)), dw,
                   members.position + doubtful_count);
        doubtful_count += hn::CountTrue(df, is_doubtful);
      }
    };
    take(base, p0, b.depth0);
    take(base + lanes, p1, b.depth1);
    take(base + 2 * lanes, p2, b.depth2);
    take(base + 3 * lanes, p3, b.depth3);
  }
  return doubtful_count;
}

}  // namespace convexcut::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace convexcut {

// Highway's table takes no noexcept functions; none of them throws.
HWY_EXPORT(gather);
HWY_EXPORT(extremes);
HWY_EXPORT(set_edges);
HWY_EXPORT(depths);
HWY_EXPORT(drop_deep);
HWY_EXPORT(mark_near);

std::size_t gather(const CloudView& sorted, std::span<const std::uint8_t> marks,
                   std::span<const ShellIndex::Range> ranges, const SlicingPlane& plane,
                   double half_width_m, float extent_m, const SliceColumns& members) noexcept {
  return HWY_DYNAMIC_DISPATCH(gather)(sorted, marks, ranges, plane, half_width_m, extent_m,
                                      members);
}

Extremes extremes(const SliceColumns& members, std::size_t count, Directions directions) noexcept {
  return HWY_DYNAMIC_DISPATCH(extremes)(members, count, directions);
}

void set_edges(std::span<const HullPoint> polygon, EdgeColumns& edges) noexcept {
  HWY_DYNAMIC_DISPATCH(set_edges)(polygon, edges);
}

std::size_t depths(const EdgeColumns& edges, const SliceColumns& members, std::size_t count,
                   float limit_m, float* depth, const SliceColumns& shallow) noexcept {
  return HWY_DYNAMIC_DISPATCH(depths)(edges, members, count, limit_m, depth, shallow);
}

std::size_t drop_deep(const float* depth, float limit_m, const SliceColumns& members,
                      std::size_t count) noexcept {
  return HWY_DYNAMIC_DISPATCH(drop_deep)(depth, limit_m, members, count);
}

std::size_t mark_near(const EdgeColumns& edges, const SliceColumns& members, std::size_t count,
                      float e_m, float tolerance_m, std::span<std::uint8_t> marks) noexcept {
  return HWY_DYNAMIC_DISPATCH(mark_near)(edges, members, count, e_m, tolerance_m, marks);
}

}  // namespace convexcut
#endif
