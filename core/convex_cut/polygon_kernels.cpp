// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/polygon_kernels.hpp"

#include <bit>
#include <limits>

#include "core/convex_cut/orientation.hpp"

#undef HWY_TARGET_INCLUDE
// Highway includes this file again for each instruction set.
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define HWY_TARGET_INCLUDE "core/convex_cut/polygon_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Behind foreach_target.h.
#include "core/simd/kernel_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace convexcut::HWY_NAMESPACE {

constexpr float kFarAway = std::numeric_limits<float>::max();

void set_edges(const Polygon polygon, PolygonEdges& all_edges) {
  PolygonEdges edges = all_edges;
  using Doubles = hn::ScalableTag<double>;
  const Doubles dd;
  const hn::Rebind<float, Doubles> df;
  const std::size_t lanes = hn::Lanes(dd);
  auto least_u = hn::Set(df, kFarAway);
  auto most_u = hn::Set(df, -kFarAway);
  for (std::size_t k = 0; k < polygon.size; k += lanes) {
    const auto from_u = hn::LoadU(dd, polygon.u + k - 1);
    const auto to_u = hn::LoadU(dd, polygon.u + k);
    const auto to_z = hn::LoadU(dd, polygon.z + k);
    const auto edge_u = hn::Sub(to_u, from_u);
    const auto edge_z = hn::Sub(to_z, hn::LoadU(dd, polygon.z + k - 1));
    const auto squared_length = hn::MulAdd(edge_u, edge_u, hn::Mul(edge_z, edge_z));
    const auto inverse_length = hn::Div(hn::Set(dd, 1.0), hn::Sqrt(squared_length));
    // Counter-clockwise: the inside is on the left.
    const auto normal_u = hn::Neg(hn::Mul(edge_z, inverse_length));
    const auto normal_z = hn::Mul(edge_u, inverse_length);
    const auto offset = hn::MulAdd(normal_u, to_u, hn::Mul(normal_z, to_z));
    hn::StoreU(hn::DemoteTo(df, normal_u), df, edges.normal_u + k);
    hn::StoreU(hn::DemoteTo(df, normal_z), df, edges.normal_z + k);
    hn::StoreU(hn::DemoteTo(df, offset), df, edges.offset + k);
    const auto from = hn::DemoteTo(df, from_u);
    const auto to = hn::DemoteTo(df, to_u);
    hn::StoreU(hn::Min(from, to), df, edges.least_u + k);
    hn::StoreU(hn::Max(from, to), df, edges.most_u + k);
    const auto present = hn::FirstN(df, polygon.size - k);
    least_u = hn::Min(least_u, hn::IfThenElse(present, to, least_u));
    most_u = hn::Max(most_u, hn::IfThenElse(present, to, most_u));
  }
  least_u = hn::MinOfLanes(df, least_u);
  most_u = hn::MaxOfLanes(df, most_u);
  for (std::size_t k = 0; k < polygon.size; k += lanes) {
    const auto from = hn::LoadU(df, edges.least_u + k);
    const auto to = hn::LoadU(df, edges.most_u + k);
    const auto is_first = hn::Eq(from, least_u);
    const auto is_last = hn::Eq(to, most_u);
    hn::StoreU(hn::IfThenElse(is_first, hn::Set(df, -kFarAway), from), df, edges.least_u + k);
    hn::StoreU(hn::IfThenElse(is_last, hn::Set(df, kFarAway), to), df, edges.most_u + k);
  }
  all_edges.count = polygon.size;
}

Turns find_turns(const Polygon polygon) {
  const hn::ScalableTag<double> dd;
  const auto filter = hn::Set(dd, kOrientationFilter);
  Turns turns{true, 0};
  for (std::size_t k = 0; k < polygon.size; k += hn::Lanes(dd)) {
    const auto from_u = hn::LoadU(dd, polygon.u + k - 1);
    const auto at_u = hn::LoadU(dd, polygon.u + k);
    const auto to_u = hn::LoadU(dd, polygon.u + k + 1);
    const auto to_z = hn::LoadU(dd, polygon.z + k + 1);
    // As in orientation().
    const auto left = hn::Mul(hn::Sub(from_u, to_u), hn::Sub(hn::LoadU(dd, polygon.z + k), to_z));
    const auto right =
        hn::Mul(hn::Sub(hn::LoadU(dd, polygon.z + k - 1), to_z), hn::Sub(at_u, to_u));
    const auto determinant = hn::Sub(left, right);
    const auto bound = hn::Mul(filter, hn::Add(hn::Abs(left), hn::Abs(right)));
    const auto surely_left = hn::And(hn::Ge(determinant, bound), hn::Gt(determinant, hn::Zero(dd)));
    const auto absent = hn::Not(hn::FirstN(dd, polygon.size - k));
    turns.all_left = turns.all_left && hn::AllTrue(dd, hn::Or(surely_left, absent));
    const auto reverses = hn::AndNot(absent, hn::And(hn::Ge(from_u, at_u), hn::Lt(at_u, to_u)));
    turns.rounds += hn::CountTrue(dd, reverses);
  }
  return turns;
}

// Copies the edges that are over [least_u, most_u] and returns how many these are.
HWY_INLINE std::size_t copy_facing(const PolygonEdges& edges, float least_u, float most_u,
                                   const EdgeColumns& facing) noexcept {
  const Floats df;
  const Float from = hn::Set(df, least_u);
  const Float to = hn::Set(df, most_u);
  std::size_t count = 0;
  for (std::size_t k = 0; k < edges.count; k += hn::Lanes(df)) {
    const Mask faces = hn::And(hn::And(hn::Ge(hn::LoadU(df, edges.most_u + k), from),
                                       hn::Le(hn::LoadU(df, edges.least_u + k), to)),
                               hn::FirstN(df, edges.count - k));
    const Compressor compress(faces);
    hn::StoreU(compress(hn::LoadU(df, edges.normal_u + k)), df, facing.normal_u + count);
    hn::StoreU(compress(hn::LoadU(df, edges.normal_z + k)), df, facing.normal_z + count);
    hn::StoreU(compress(hn::LoadU(df, edges.offset + k)), df, facing.offset + count);
    count += hn::CountTrue(df, faces);
  }
  return count;
}

// Two vectors of members at once: an edge is loaded once for both.
struct Pair {
  // Written out: GCC compiles an implicit one without NEON's options.
  HWY_INLINE Pair() noexcept {}  // NOLINT(modernize-use-equals-default)
  Float u0, u1;
  Float z0, z1;
  Float depth0, depth1;
};

HWY_INLINE Pair load_with_depth(const EdgeColumns& edges, std::size_t edge_count,
                                const SliceColumns& members, std::size_t i) noexcept {
  const Floats df;
  const std::size_t lanes = hn::Lanes(df);
  Pair p;
  p.u0 = hn::LoadU(df, members.u + i);
  p.u1 = hn::LoadU(df, members.u + i + lanes);
  p.z0 = hn::LoadU(df, members.z + i);
  p.z1 = hn::LoadU(df, members.z + i + lanes);
  p.depth0 = hn::Set(df, kFarAway);
  p.depth1 = p.depth0;
  for (std::size_t k = 0; k < edge_count; ++k) {
    const Float normal_u = hn::Set(df, edges.normal_u[k]);
    const Float normal_z = hn::Set(df, edges.normal_z[k]);
    const Float offset = hn::Set(df, edges.offset[k]);
    p.depth0 = least_of(p.depth0, hn::MulAdd(normal_u, p.u0, hn::MulSub(normal_z, p.z0, offset)));
    p.depth1 = least_of(p.depth1, hn::MulAdd(normal_u, p.u1, hn::MulSub(normal_z, p.z1, offset)));
  }
  return p;
}

HWY_INLINE Mask first(std::size_t i, std::size_t end) noexcept {
  return hn::FirstN(Floats(), end > i ? end - i : 0);
}

// Appends the chosen lanes to a list.
HWY_INLINE void append(Mask mask, Word values, std::uint32_t* list, std::size_t& size) noexcept {
  hn::StoreU(Compressor(mask)(values), Words(), list + size);
  size += hn::CountTrue(Floats(), mask);
}

// The structs of pointers are taken by value, here and below: behind a reference, each store of a
// vector could have changed them.
std::size_t find_shallow(const PolygonEdges edges, const EdgeColumns facing,
                         const SliceColumns members, std::span<const Stretch> stretches,
                         float limit_m, const SliceColumns shallow) {
  const Floats df;
  const std::size_t lanes = hn::Lanes(df);
  const Float limit = hn::Set(df, limit_m);
  const Word lane_numbers = hn::Iota(Words(), 0);
  std::size_t count = 0;
  for (const Stretch& stretch : stretches) {
    const std::size_t facing_count =
        copy_facing(edges, stretch.least_u_m - limit_m, stretch.most_u_m + limit_m, facing);
    const std::size_t end = stretch.end;
    for (std::size_t i = stretch.begin; i < end; i += 2 * lanes) {
      const Pair p = load_with_depth(facing, facing_count, members, i);
      const Mask shallow0 = hn::And(hn::Le(p.depth0, limit), first(i, end));
      const Mask shallow1 = hn::And(hn::Le(p.depth1, limit), first(i + lanes, end));
      if (hn::AllFalse(df, hn::Or(shallow0, shallow1))) continue;
      const Word index = hn::Add(lane_numbers, hn::Set(Words(), static_cast<std::uint32_t>(i)));
      const Word next = hn::Set(Words(), static_cast<std::uint32_t>(lanes));
      append(shallow0, index, shallow.position, count);
      append(shallow1, hn::Add(index, next), shallow.position, count);
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t member = shallow.position[k];
    shallow.u[k] = members.u[member];
    shallow.z[k] = members.z[member];
    shallow.position[k] = members.position[member] & ~kMarked;
  }
  return count;
}

std::size_t mark_near(const PolygonEdges edges, const EdgeColumns facing,
                      const SliceColumns members, std::span<const Stretch> stretches,
                      float surely_m, float limit_m, std::span<std::uint8_t> marks,
                      std::uint32_t* near, std::uint32_t* doubtful) {
  const Floats df;
  const Words dw;
  const std::size_t lanes = hn::Lanes(df);
  const Float surely = hn::Set(df, surely_m);
  const Float possibly = hn::Set(df, limit_m);
  const Word marked = hn::Set(dw, kMarked);
  std::size_t near_count = 0;
  std::size_t doubtful_count = 0;
  for (const Stretch& stretch : stretches) {
    const std::size_t end = stretch.end;
    const std::size_t facing_count =
        copy_facing(edges, stretch.least_u_m - limit_m, stretch.most_u_m + limit_m, facing);
    const auto take = [&](Word position, Mask unmarked, Float depth) HWY_ATTR {
      const Mask is_near = hn::And(hn::Lt(depth, surely), unmarked);
      append(is_near, position, near, near_count);
      const Mask is_doubtful = hn::AndNot(is_near, hn::And(hn::Le(depth, possibly), unmarked));
      if (HWY_UNLIKELY(!hn::AllFalse(df, is_doubtful))) {
        append(is_doubtful, position, doubtful, doubtful_count);
      }
    };
    for (std::size_t i = stretch.begin; i < end; i += 2 * lanes) {
      const Word position0 = hn::LoadU(dw, members.position + i);
      const Word position1 = hn::LoadU(dw, members.position + i + lanes);
      const Mask unmarked0 = hn::And(hn::RebindMask(df, hn::Lt(position0, marked)), first(i, end));
      const Mask unmarked1 =
          hn::And(hn::RebindMask(df, hn::Lt(position1, marked)), first(i + lanes, end));
      if (hn::AllFalse(df, hn::Or(unmarked0, unmarked1))) continue;
      const Pair p = load_with_depth(facing, facing_count, members, i);
      take(position0, unmarked0, p.depth0);
      take(position1, unmarked1, p.depth1);
    }
  }
  for (std::size_t k = 0; k < near_count; ++k) marks[near[k]] = 1;
  return doubtful_count;
}

std::size_t drop_deep(const EdgeColumns edges, const SliceColumns members, std::size_t count,
                      float limit_m) {
  const Floats df;
  const Words dw;
  const std::size_t lanes = hn::Lanes(df);
  const Float limit = hn::Set(df, limit_m);
  std::size_t left = 0;
  const auto keep = [&](Mask stays, Float u, Float z, Word position) HWY_ATTR {
    const Compressor compress(stays);
    hn::StoreU(compress(u), df, members.u + left);
    hn::StoreU(compress(z), df, members.z + left);
    hn::StoreU(compress(position), dw, members.position + left);
    left += hn::CountTrue(df, stays);
  };
  for (std::size_t i = 0; i < count; i += 2 * lanes) {
    const Pair p = load_with_depth(edges, edges.count, members, i);
    const Word position0 = hn::LoadU(dw, members.position + i);
    const Word position1 = hn::LoadU(dw, members.position + i + lanes);
    keep(hn::And(hn::Le(p.depth0, limit), first(i, count)), p.u0, p.z0, position0);
    keep(hn::And(hn::Le(p.depth1, limit), first(i + lanes, count)), p.u1, p.z1, position1);
  }
  return left;
}

void farthest_outside(const EdgeColumns edges, const SliceColumns members, std::size_t count,
                      float tolerance_m, std::uint32_t* found) {
  const Floats df;
  const Words dw;
  const auto tag_mask = static_cast<std::uint32_t>(std::bit_ceil(count) - 1);
  const Word keep = hn::Set(dw, ~tag_mask);
  const Float outside = hn::Set(df, -tolerance_m);
  for (std::size_t k = 0; k < edges.count; k += hn::Lanes(df)) {
    const Float normal_u = hn::LoadU(df, edges.normal_u + k);
    const Float normal_z = hn::LoadU(df, edges.normal_z + k);
    const Float offset = hn::LoadU(df, edges.offset + k);
    Float least = hn::Zero(df);
    for (std::size_t i = 0; i < count; ++i) {
      const Float depth = hn::MulAdd(normal_u, hn::Set(df, members.u[i]),
                                     hn::MulSub(normal_z, hn::Set(df, members.z[i]), offset));
      least = least_of(least, tagged(depth, hn::Set(dw, static_cast<std::uint32_t>(i)), keep));
    }
    const Word tag = hn::And(hn::BitCast(dw, least), hn::Set(dw, tag_mask));
    const auto is_found = hn::RebindMask(dw, hn::Lt(least, outside));
    hn::StoreU(hn::IfThenElse(is_found, tag, hn::Set(dw, kNobody)), dw, found + k);
  }
}

}  // namespace convexcut::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace convexcut {

// Highway's table takes no noexcept functions; none of them throws.
HWY_EXPORT(set_edges);
HWY_EXPORT(find_turns);
HWY_EXPORT(find_shallow);
HWY_EXPORT(drop_deep);
HWY_EXPORT(farthest_outside);
HWY_EXPORT(mark_near);

void set_edges(const Polygon& polygon, PolygonEdges& edges) noexcept {
  HWY_DYNAMIC_DISPATCH(set_edges)(polygon, edges);
}

Turns find_turns(const Polygon& polygon) noexcept {
  return HWY_DYNAMIC_DISPATCH(find_turns)(polygon);
}

std::size_t find_shallow(const PolygonEdges& edges, const EdgeColumns& facing,
                         const SliceColumns& members, std::span<const Stretch> stretches,
                         float limit_m, const SliceColumns& shallow) noexcept {
  return HWY_DYNAMIC_DISPATCH(find_shallow)(edges, facing, members, stretches, limit_m, shallow);
}

std::size_t drop_deep(const EdgeColumns& edges, const SliceColumns& members, std::size_t count,
                      float limit_m) noexcept {
  return HWY_DYNAMIC_DISPATCH(drop_deep)(edges, members, count, limit_m);
}

void farthest_outside(const EdgeColumns& edges, const SliceColumns& members, std::size_t count,
                      float tolerance_m, std::uint32_t* found) noexcept {
  HWY_DYNAMIC_DISPATCH(farthest_outside)(edges, members, count, tolerance_m, found);
}

std::size_t mark_near(const PolygonEdges& edges, const EdgeColumns& facing,
                      const SliceColumns& members, std::span<const Stretch> stretches,
                      float surely_m, float limit_m, std::span<std::uint8_t> marks,
                      std::uint32_t* near, std::uint32_t* doubtful) noexcept {
  return HWY_DYNAMIC_DISPATCH(mark_near)(edges, facing, members, stretches, surely_m, limit_m,
                                         marks, near, doubtful);
}

}  // namespace convexcut
#endif
