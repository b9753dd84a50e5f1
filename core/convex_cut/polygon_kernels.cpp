// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/polygon_kernels.hpp"

#include <bit>
#include <limits>

#undef HWY_TARGET_INCLUDE
// Highway includes this file again for each instruction set.
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define HWY_TARGET_INCLUDE "core/convex_cut/polygon_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Behind foreach_target.h.
#include "core/convex_cut/kernel_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace convexcut::HWY_NAMESPACE {

constexpr float kFarAway = std::numeric_limits<float>::max();

void set_edges(const Polygon& polygon, EdgeColumns& edges) {
  using Doubles = hn::ScalableTag<double>;
  const Doubles dd;
  const hn::Rebind<float, Doubles> df;
  const std::size_t lanes = hn::Lanes(dd);
  for (std::size_t k = 0; k < polygon.size; k += lanes) {
    const auto to_u = hn::LoadU(dd, polygon.u + k);
    const auto to_z = hn::LoadU(dd, polygon.z + k);
    const auto edge_u = hn::Sub(to_u, hn::LoadU(dd, polygon.u + k - 1));
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
  }
  edges.count = polygon.size;
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

// Appends the lanes of a mask to columns that hold `size` members.
HWY_INLINE void append(const SliceColumns& columns, std::size_t& size, Mask mask, Float u, Float z,
                       Word position) noexcept {
  const Floats df;
  const Compressor compress(mask);
  hn::StoreU(compress(u), df, columns.u + size);
  hn::StoreU(compress(z), df, columns.z + size);
  hn::StoreU(compress(position), Words(), columns.position + size);
  size += hn::CountTrue(df, mask);
}

Sifted sift(const EdgeColumns& edges, const SliceColumns& members, std::size_t count,
            float shallow_m, float open_m, const SliceColumns& shallow) {
  const Floats df;
  const Words dw;
  const std::size_t lanes = hn::Lanes(df);
  const Float shallow_limit = hn::Set(df, shallow_m);
  const Float open_limit = hn::Set(df, open_m);
  const Word marked = hn::Set(dw, kMarked);
  Sifted sifted;
  for (std::size_t base = 0; base < count; base += 4 * lanes) {
    const Block b = load_with_depth(edges, members, base);
    const auto take = [&](std::size_t i, Float u, Float z, Float depth) HWY_ATTR {
      const Mask present = hn::FirstN(df, count > i ? count - i : 0);
      const Word position = hn::LoadU(dw, members.position + i);
      const Mask is_shallow = hn::And(hn::Le(depth, shallow_limit), present);
      if (!hn::AllFalse(df, is_shallow)) {
        append(shallow, sifted.shallow, is_shallow, u, z, hn::AndNot(marked, position));
      }
      const Mask unmarked = hn::RebindMask(df, hn::Eq(hn::And(position, marked), hn::Zero(dw)));
      const Mask is_open = hn::And(hn::And(hn::Le(depth, open_limit), present), unmarked);
      if (!hn::AllFalse(df, is_open)) append(members, sifted.open, is_open, u, z, position);
    };
    take(base, b.u0, b.z0, b.depth0);
    take(base + lanes, b.u1, b.z1, b.depth1);
    take(base + 2 * lanes, b.u2, b.z2, b.depth2);
    take(base + 3 * lanes, b.u3, b.z3, b.depth3);
  }
  return sifted;
}

std::size_t drop_deep(const EdgeColumns& edges, const SliceColumns& members, std::size_t count,
                      float limit_m) {
  const Floats df;
  const Words dw;
  const std::size_t lanes = hn::Lanes(df);
  const Float limit = hn::Set(df, limit_m);
  std::size_t left = 0;
  for (std::size_t base = 0; base < count; base += 4 * lanes) {
    const Block b = load_with_depth(edges, members, base);
    const auto take = [&](std::size_t i, Float u, Float z, Float depth) HWY_ATTR {
      const Mask stays = hn::And(hn::Le(depth, limit), hn::FirstN(df, count > i ? count - i : 0));
      if (hn::AllFalse(df, stays)) return;
      append(members, left, stays, u, z, hn::LoadU(dw, members.position + i));
    };
    take(base, b.u0, b.z0, b.depth0);
    take(base + lanes, b.u1, b.z1, b.depth1);
    take(base + 2 * lanes, b.u2, b.z2, b.depth2);
    take(base + 3 * lanes, b.u3, b.z3, b.depth3);
  }
  return left;
}

void farthest_outside(const EdgeColumns& edges, const SliceColumns& members, std::size_t count,
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
      const Float depth =
          hn::MulAdd(normal_u, hn::Set(df, members.u[i]),
                     hn::MulSub(normal_z, hn::Set(df, members.z[i]), offset));
      least = hn::Min(least, tagged(depth, hn::Set(dw, static_cast<std::uint32_t>(i)), keep));
    }
    const Word tag = hn::And(hn::BitCast(dw, least), hn::Set(dw, tag_mask));
    const auto is_found = hn::RebindMask(dw, hn::Lt(least, outside));
    hn::StoreU(hn::IfThenElse(is_found, tag, hn::Set(dw, kNobody)), dw, found + k);
  }
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
      hn::Store(Compressor(is_near)(position), dw, near);
      const std::size_t near_count = hn::CountTrue(df, is_near);
      for (std::size_t k = 0; k < near_count; ++k) marks[near[k]] = 1;
      if (HWY_UNLIKELY(!hn::AllFalse(df, is_doubtful))) {
        hn::StoreU(Compressor(is_doubtful)(position), dw, members.position + doubtful_count);
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
HWY_EXPORT(set_edges);
HWY_EXPORT(sift);
HWY_EXPORT(drop_deep);
HWY_EXPORT(farthest_outside);
HWY_EXPORT(mark_near);

void set_edges(const Polygon& polygon, EdgeColumns& edges) noexcept {
  HWY_DYNAMIC_DISPATCH(set_edges)(polygon, edges);
}

Sifted sift(const EdgeColumns& edges, const SliceColumns& members, std::size_t count,
            float shallow_m, float open_m, const SliceColumns& shallow) noexcept {
  return HWY_DYNAMIC_DISPATCH(sift)(edges, members, count, shallow_m, open_m, shallow);
}

std::size_t drop_deep(const EdgeColumns& edges, const SliceColumns& members, std::size_t count,
                      float limit_m) noexcept {
  return HWY_DYNAMIC_DISPATCH(drop_deep)(edges, members, count, limit_m);
}

void farthest_outside(const EdgeColumns& edges, const SliceColumns& members, std::size_t count,
                      float tolerance_m, std::uint32_t* found) noexcept {
  HWY_DYNAMIC_DISPATCH(farthest_outside)(edges, members, count, tolerance_m, found);
}

std::size_t mark_near(const EdgeColumns& edges, const SliceColumns& members, std::size_t count,
                      float e_m, float tolerance_m, std::span<std::uint8_t> marks) noexcept {
  return HWY_DYNAMIC_DISPATCH(mark_near)(edges, members, count, e_m, tolerance_m, marks);
}

}  // namespace convexcut
#endif
