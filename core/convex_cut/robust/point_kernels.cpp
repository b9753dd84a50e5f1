// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/point_kernels.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
// Highway includes this file again for each instruction set.
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define HWY_TARGET_INCLUDE "core/convex_cut/robust/point_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Behind foreach_target.h.
#include "core/simd/kernel_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace convexcut::robust::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace lanes_of = convexcut::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::ScalableTag<std::int32_t>;
using Float = hn::Vec<Floats>;
using Int = hn::Vec<Ints>;
using Words = hn::ScalableTag<std::uint32_t>;
using Word = hn::Vec<Words>;

// One axis of RigPose::apply.
struct Axis {
  Float x, y, z, position, step;

  HWY_INLINE Axis(const RigPose& pose, Eigen::Index axis) noexcept
      : x(hn::Set(Floats(), pose.r_window_from_level(axis, 0))),
        y(hn::Set(Floats(), pose.r_window_from_level(axis, 1))),
        z(hn::Set(Floats(), pose.r_window_from_level(axis, 2))),
        position(hn::Set(Floats(), pose.position[axis])),
        step(hn::Set(Floats(), pose.step[axis])) {}

  HWY_INLINE Float of(Float px, Float py, Float pz, Float from_middle) const noexcept {
    const Float turned = lanes_of::dot(x, y, z, px, py, pz);
    return hn::Add(hn::Add(turned, position), hn::Mul(from_middle, step));
  }
};

// place_of(), centre_of() and Moments' millimetres.
HWY_INLINE void place(Float p, std::int32_t* lattice, std::int32_t* millimetres) noexcept {
  const Floats df;
  const Ints di;
  const Float voxel = hn::Set(df, kVoxelM);
  const Float limit = hn::Set(df, kLatticeLimit);
  const Float step = hn::Min(hn::Max(hn::Floor(hn::Div(p, voxel)), hn::Neg(limit)), limit);
  const Float centre = hn::Mul(hn::Add(step, hn::Set(df, 0.5F)), voxel);
  const Float most = hn::Set(df, kMostOffsetM);
  const Float off = hn::Min(hn::Max(hn::Sub(p, centre), hn::Neg(most)), most);
  hn::Store(hn::ConvertTo(di, step), di, lattice);
  hn::Store(hn::NearestInt(hn::Mul(off, hn::Set(df, 1e3F))), di, millimetres);
}

// Calls take(i, x, y, z) for whole vectors of the points [begin, begin + kPointsAtOnce), moved, i
// from 0 on; behind the cloud's end points are anything.
template <class Take>
HWY_INLINE void for_each_moved(const CloudView& cloud, std::size_t begin, const RigPose& pose,
                               Take&& take) noexcept {
  const Floats df;
  const Ints di;
  const std::size_t lanes = hn::Lanes(df);
  const Axis to_x(pose, 0);
  const Axis to_y(pose, 1);
  const Axis to_z(pose, 2);
  const Float points = hn::Set(df, static_cast<float>(cloud.size()));
  const auto move_at = [&](std::size_t i, const float* xs, const float* ys,
                           const float* zs) HWY_ATTR {
    const Float number = hn::ConvertTo(df, hn::Iota(di, static_cast<std::int32_t>(begin + i)));
    const Float from_middle = hn::Sub(hn::Div(number, points), hn::Set(df, 0.5F));
    const Float x = hn::LoadU(df, xs);
    const Float y = hn::LoadU(df, ys);
    const Float z = hn::LoadU(df, zs);
    take(i, to_x.of(x, y, z, from_middle), to_y.of(x, y, z, from_middle),
         to_z.of(x, y, z, from_middle));
  };
  const std::size_t count = std::min(kPointsAtOnce, cloud.size() - begin);
  const float* x = cloud.x.data() + begin;
  const float* y = cloud.y.data() + begin;
  const float* z = cloud.z.data() + begin;
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) move_at(i, x + i, y + i, z + i);
  if (i == count) return;
  HWY_ALIGN float last[3][hn::MaxLanes(df)] = {};
  std::copy(x + i, x + count, last[0]);
  std::copy(y + i, y + count, last[1]);
  std::copy(z + i, z + count, last[2]);
  move_at(i, last[0], last[1], last[2]);
}

void place_points(const CloudView& cloud, std::size_t begin, const RigPose& pose,
                  PlacedPoints& placed) {
  for_each_moved(cloud, begin, pose, [&](std::size_t i, Float x, Float y, Float z) HWY_ATTR {
    place(x, &placed.x[i], &placed.x_mm[i]);
    place(y, &placed.y[i], &placed.y_mm[i]);
    place(z, &placed.z[i], &placed.z_mm[i]);
  });
}

void move_cloud(const CloudView& cloud, std::size_t begin, const RigPose& pose,
                MovedPoints& moved) {
  for_each_moved(cloud, begin, pose, [&](std::size_t i, Float x, Float y, Float z) HWY_ATTR {
    hn::Store(x, Floats(), &moved.x[i]);
    hn::Store(y, Floats(), &moved.y[i]);
    hn::Store(z, Floats(), &moved.z[i]);
  });
}

// The planes from `first` on that are asked for and within the gate, a bit each.
HWY_INLINE Word near_planes(std::span<const Plane> planes, std::uint64_t asked, std::size_t first,
                            Float x, Float y, Float z, Float gate) noexcept {
  const Floats df;
  const Words dw;
  Word near = hn::Zero(dw);
  for (std::size_t k = first; k < std::min(planes.size(), first + 32); ++k) {
    const Plane& plane = planes[k];
    if ((asked >> k & 1U) == 0) continue;
    const Float along = lanes_of::dot(hn::Set(df, plane.normal.x()), hn::Set(df, plane.normal.y()),
                                      hn::Set(df, plane.normal.z()), x, y, z);
    const auto is_near = hn::Le(hn::Abs(hn::Add(along, hn::Set(df, plane.offset))), gate);
    near = hn::Or(near, hn::IfThenElseZero(hn::RebindMask(dw, is_near),
                                           hn::Set(dw, std::uint32_t{1} << (k - first))));
  }
  return near;
}

void move_points(const PointColumns points, const float* from_middle, const RigPose& pose,
                 MovedPoints& moved) {
  const Floats df;
  const Axis to_x(pose, 0);
  const Axis to_y(pose, 1);
  const Axis to_z(pose, 2);
  for (std::size_t i = 0; i < kPointsAtOnce; i += hn::Lanes(df)) {
    const Float x = hn::LoadU(df, points.x + i);
    const Float y = hn::LoadU(df, points.y + i);
    const Float z = hn::LoadU(df, points.z + i);
    const Float middle = hn::LoadU(df, from_middle + i);
    hn::Store(to_x.of(x, y, z, middle), df, &moved.x[i]);
    hn::Store(to_y.of(x, y, z, middle), df, &moved.y[i]);
    hn::Store(to_z.of(x, y, z, middle), df, &moved.z[i]);
  }
}

void find_planes(const PointColumns points, std::span<const Plane> planes, std::uint64_t asked,
                 float gate_m, PlaneSets& found) {
  const Floats df;
  const Words dw;
  const Float gate = hn::Set(df, gate_m);
  for (std::size_t i = 0; i < kPointsAtOnce; i += hn::Lanes(df)) {
    const Float x = hn::LoadU(df, points.x + i);
    const Float y = hn::LoadU(df, points.y + i);
    const Float z = hn::LoadU(df, points.z + i);
    hn::Store(near_planes(planes, asked, 0, x, y, z, gate), dw, &found.low[i]);
    hn::Store(near_planes(planes, asked, 32, x, y, z, gate), dw, &found.high[i]);
  }
}

}  // namespace convexcut::robust::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace convexcut::robust {

// Highway's table takes no noexcept functions; none of them throws.
HWY_EXPORT(place_points);
HWY_EXPORT(move_cloud);
HWY_EXPORT(move_points);
HWY_EXPORT(find_planes);

void place_points(const CloudView& cloud, std::size_t begin, const RigPose& pose,
                  PlacedPoints& placed) noexcept {
  HWY_DYNAMIC_DISPATCH(place_points)(cloud, begin, pose, placed);
}

void move_points(const PointColumns& points, const float* from_middle, const RigPose& pose,
                 MovedPoints& moved) noexcept {
  HWY_DYNAMIC_DISPATCH(move_points)(points, from_middle, pose, moved);
}

void move_points(const CloudView& cloud, std::size_t begin, const RigPose& pose,
                 MovedPoints& moved) noexcept {
  HWY_DYNAMIC_DISPATCH(move_cloud)(cloud, begin, pose, moved);
}

std::uint64_t accepted_planes(std::span<const Plane> planes) noexcept {
  std::uint64_t accepted = 0;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    accepted |= std::uint64_t{planes[k].accepted ? 1U : 0U} << k;
  }
  return accepted;
}

void find_planes(const PointColumns& points, std::span<const Plane> planes, std::uint64_t asked,
                 float gate_m, PlaneSets& found) noexcept {
  HWY_DYNAMIC_DISPATCH(find_planes)(points, planes, asked, gate_m, found);
}

}  // namespace convexcut::robust
#endif
