// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/ray_kernels.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
// Highway includes this file again for each instruction set.
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define HWY_TARGET_INCLUDE "core/convex_cut/robust/ray_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Behind foreach_target.h.
#include "core/simd/kernel_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace convexcut::robust::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace lanes_of = convexcut::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::ScalableTag<std::int32_t>;
using Words = hn::ScalableTag<std::uint32_t>;
using Float = hn::Vec<Floats>;
using Int = hn::Vec<Ints>;

struct Point {
  Float x, y, z;
};

// A direction that points are measured along.
struct Direction {
  Float x, y, z;

  HWY_INLINE explicit Direction(const Vec3f& v) noexcept
      : x(hn::Set(Floats(), v.x())), y(hn::Set(Floats(), v.y())), z(hn::Set(Floats(), v.z())) {}
  HWY_INLINE Float dot(const Point& p) const noexcept {
    return lanes_of::dot(x, y, z, p.x, p.y, p.z);
  }
};

HWY_INLINE Point load(const Rays& rays, std::size_t first_column, std::size_t i) noexcept {
  return {hn::LoadU(Floats(), rays.column(first_column) + i),
          hn::LoadU(Floats(), rays.column(first_column + 1) + i),
          hn::LoadU(Floats(), rays.column(first_column + 2) + i)};
}

// The cell that lies so far along an axis, from the first one on.
HWY_INLINE Int cell_of(Float along_m, std::int32_t first) noexcept {
  const Float cells = hn::Floor(hn::Div(along_m, hn::Set(Floats(), kCellM)));
  return hn::Sub(hn::ConvertTo(Ints(), cells), hn::Set(Ints(), first));
}

HWY_INLINE hn::Mask<Ints> is_within(Int i, std::int32_t count) noexcept {
  const Ints di;
  return hn::And(hn::Gt(i, hn::Set(di, -1)), hn::Lt(i, hn::Set(di, count)));
}

void find_passages(const Rays& rays, std::size_t begin, const Plane& plane, const PlaneGrid& grid,
                   float behind_m, float in_front_m, Passages& passages) {
  const Floats df;
  const Ints di;
  const Words dw;
  const Direction normal(plane.normal);
  const Direction along(grid.along);
  const Direction up(grid.up);
  const Float offset = hn::Set(df, plane.offset);
  const Float behind = hn::Set(df, -behind_m);
  const Float in_front = hn::Set(df, in_front_m);
  const std::size_t end = std::min(begin + kRaysAtOnce, rays.size());
  std::size_t count = 0;
  for (std::size_t i = begin; i < end; i += hn::Lanes(df)) {
    const Point seen = load(rays, 3, i);
    const Float height_of_end = hn::Add(normal.dot(seen), offset);
    const auto ends_behind = hn::And(hn::Le(height_of_end, behind), hn::FirstN(df, end - i));
    if (hn::AllFalse(df, ends_behind)) continue;
    const Point origin = load(rays, 0, i);
    const Float height = hn::Add(normal.dot(origin), offset);
    const auto passes = hn::And(ends_behind, hn::Ge(height, in_front));
    const Float share = hn::Div(height, hn::Sub(height, height_of_end));
    const Point at{hn::Add(origin.x, hn::Mul(share, hn::Sub(seen.x, origin.x))),
                   hn::Add(origin.y, hn::Mul(share, hn::Sub(seen.y, origin.y))),
                   hn::Add(origin.z, hn::Mul(share, hn::Sub(seen.z, origin.z)))};
    const Float along_m = along.dot(at);
    const Int column = cell_of(along_m, grid.first_along);
    const Int row = cell_of(up.dot(at), grid.first_up);
    const auto held = hn::And(passes, hn::RebindMask(df, hn::And(is_within(column, grid.columns),
                                                                 is_within(row, grid.rows))));
    const Int cell = hn::Add(hn::Mul(row, hn::Set(di, grid.columns)), column);
    const lanes_of::Compressor compress(held);
    hn::StoreU(compress(hn::Iota(dw, static_cast<std::uint32_t>(i))), dw, &passages.ray[count]);
    hn::StoreU(hn::BitCast(di, compress(hn::BitCast(dw, column))), di, &passages.column[count]);
    hn::StoreU(hn::BitCast(di, compress(hn::BitCast(dw, cell))), di, &passages.cell[count]);
    hn::StoreU(compress(along_m), df, &passages.along_m[count]);
    count += hn::CountTrue(df, held);
  }
  passages.count = count;
}

}  // namespace convexcut::robust::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace convexcut::robust {

// Highway's table takes no noexcept functions; none of them throws.
HWY_EXPORT(find_passages);

void find_passages(const Rays& rays, std::size_t begin, const Plane& plane, const PlaneGrid& grid,
                   float behind_m, float in_front_m, Passages& passages) noexcept {
  HWY_DYNAMIC_DISPATCH(find_passages)
  (rays, begin, plane, grid, behind_m, in_front_m, passages);
}

}  // namespace convexcut::robust
#endif
