// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/shape_kernels.hpp"

#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
// Highway includes this file again for each instruction set.
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define HWY_TARGET_INCLUDE "core/convex_cut/robust/shape_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Behind foreach_target.h.
#include "core/simd/kernel_lanes-inl.hpp"

#ifndef CONVEXCUT_SHAPE_KERNELS_ONCE
#define CONVEXCUT_SHAPE_KERNELS_ONCE
namespace convexcut::robust {

// Sums over the points of each neighbourhood: of coordinates in m, of their products in m².
struct SpreadColumns {
  using Column = std::array<float, kShapesAtOnce>;
  alignas(64) Column count{};
  Column x{}, y{}, z{};
  Column xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
};

// The compilers' vectors: eight at a time, or twice four. Of a voxel's Moments from the last sum
// on: what lies before its products is summed up as well, for nothing.
using FourFloats = float __attribute__((vector_size(16)));
using FourInts = std::int32_t __attribute__((vector_size(16)));
using EightFloats = float __attribute__((vector_size(32)));
using EightInts = std::int32_t __attribute__((vector_size(32)));
constexpr std::size_t kLastSum = 2 * sizeof(std::int32_t);
static_assert(offsetof(Moments, sum_mm) == 0 && offsetof(Moments, count) == 12 &&
              offsetof(Moments, products_mm2) == 16 && sizeof(Moments) == 40);

// From the middle one's centre to a voxel's, in metres: as summed with the sums, and as the rows
// and columns of the products xx xy xz yy yz zz.
struct Shift {
  FourFloats own{};
  EightFloats rows{}, columns{};
};
constexpr auto kShifts = [] {
  std::array<Shift, Around::kMost> shifts;
  for (std::size_t step = 0; step < shifts.size(); ++step) {
    const Lattice lattice = Neighbourhood::step_of(step);
    const float x = static_cast<float>(lattice[0]) * kVoxelM;
    const float y = static_cast<float>(lattice[1]) * kVoxelM;
    const float z = static_cast<float>(lattice[2]) * kVoxelM;
    shifts[step].own = FourFloats{x, y, z, 0.0F};
    shifts[step].rows = EightFloats{0.0F, 0.0F, x, y, z, y, z, z};
    shifts[step].columns = EightFloats{0.0F, 0.0F, x, x, x, y, y, z};
  }
  return shifts;
}();

// Of each angle atan2(y, x) / 3; the library's functions, for their bits.
struct Thirds {
  alignas(64) std::array<float, kShapesAtOnce> x{}, y{}, cosine{}, sine{};

  void take() noexcept {
    for (std::size_t i = 0; i < kShapesAtOnce; ++i) {
      const float theta = std::atan2(y[i], x[i]) * (1.0F / 3.0F);
      cosine[i] = std::cos(theta);
      sine[i] = std::sin(theta);
    }
  }
};

}  // namespace convexcut::robust
#endif

HWY_BEFORE_NAMESPACE();
namespace convexcut::robust::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace lanes_of = convexcut::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kShapesAtOnce>;
using Ints = hn::Rebind<std::int32_t, Floats>;
using Float = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;

constexpr float kFewPoints = 6.0F;
// The square of what a surface and the sensor's noise on it may be thick, root mean square.
constexpr float kThickness2 = 0.035F * 0.035F;
constexpr float kLeastNoise2 = 2e-4F;

HWY_INLINE Float set(float value) noexcept { return hn::Set(Floats(), value); }

struct Vector {
  // Written out: GCC compiles implicit ones without the target's options.
  HWY_INLINE Vector(Float x0, Float y0, Float z0) noexcept : x(x0), y(y0), z(z0) {}
  Float x, y, z;
};

HWY_INLINE Float dot(const Vector& a, const Vector& b) noexcept {
  return lanes_of::dot(a.x, a.y, a.z, b.x, b.y, b.z);
}
HWY_INLINE Vector cross(const Vector& a, const Vector& b) noexcept {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
HWY_INLINE Vector choose(Mask which, const Vector& yes, const Vector& no) noexcept {
  return {hn::IfThenElse(which, yes.x, no.x), hn::IfThenElse(which, yes.y, no.y),
          hn::IfThenElse(which, yes.z, no.z)};
}
HWY_INLINE Vector divided(const Vector& v, Float by) noexcept {
  return {hn::Div(v.x, by), hn::Div(v.y, by), hn::Div(v.z, by)};
}
HWY_INLINE Float not_negative(Float v) noexcept {
  return hn::IfThenElse(hn::Lt(v, hn::Zero(Floats())), hn::Zero(Floats()), v);
}
HWY_INLINE Float greatest(Float a, Float b) noexcept { return hn::IfThenElse(hn::Lt(a, b), b, a); }

struct Symmetric {
  HWY_INLINE Symmetric(Float xx0, Float xy0, Float xz0, Float yy0, Float yz0, Float zz0) noexcept
      : xx(xx0), xy(xy0), xz(xz0), yy(yy0), yz(yz0), zz(zz0) {}
  Float xx, xy, xz, yy, yz, zz;

  HWY_INLINE Symmetric less_diagonal(Float shift) const noexcept {
    return {hn::Sub(xx, shift), xy, xz, hn::Sub(yy, shift), yz, hn::Sub(zz, shift)};
  }
};

void sum_up(const Around& around, SpreadColumns& to, std::size_t at) {
  FourFloats all_sums{};
  EightFloats all_products{};
  for (std::size_t k = 0; k < around.count; ++k) {
    const Shift& shift = kShifts[around.step[k]];
    const auto* const from = reinterpret_cast<const std::byte*>(around.moments[k]);
    FourInts sums_mm;
    EightInts products_mm2;
    std::memcpy(&sums_mm, from, sizeof(sums_mm));
    std::memcpy(&products_mm2, from + kLastSum, sizeof(products_mm2));
    const FourFloats sums =
        __builtin_convertvector(sums_mm, FourFloats) * FourFloats{1e-3F, 1e-3F, 1e-3F, 1.0F};
    const FourFloats n = __builtin_shufflevector(sums, sums, 3, 3, 3, 3);
    all_sums += sums + n * shift.own;
    const EightFloats ns = __builtin_shufflevector(sums, sums, 3, 3, 3, 3, 3, 3, 3, 3);
    const EightFloats rows = __builtin_shufflevector(sums, sums, 0, 0, 0, 1, 2, 1, 2, 2);
    const EightFloats columns = __builtin_shufflevector(sums, sums, 0, 0, 0, 0, 0, 1, 1, 2);
    all_products += __builtin_convertvector(products_mm2, EightFloats) * 1e-6F +
                    shift.rows * columns + rows * shift.columns + ns * shift.rows * shift.columns;
  }
  to.x[at] = all_sums[0];
  to.y[at] = all_sums[1];
  to.z[at] = all_sums[2];
  to.count[at] = all_sums[3];
  to.xx[at] = all_products[2];
  to.xy[at] = all_products[3];
  to.xz[at] = all_products[4];
  to.yy[at] = all_products[5];
  to.yz[at] = all_products[6];
  to.zz[at] = all_products[7];
}

// As covariance().
HWY_INLINE Symmetric covariance(const SpreadColumns& s, std::size_t i) noexcept {
  const auto load = [i](const SpreadColumns::Column& column)
                        HWY_ATTR { return hn::LoadU(Floats(), column.data() + i); };
  const Float count = load(s.count);
  const Vector mean = divided({load(s.x), load(s.y), load(s.z)}, count);
  const auto entry = [&](const SpreadColumns::Column& products, Float a, Float b) HWY_ATTR {
    return hn::Sub(hn::Div(load(products), count), hn::Mul(a, b));
  };
  return {entry(s.xx, mean.x, mean.x), entry(s.xy, mean.x, mean.y), entry(s.xz, mean.x, mean.z),
          entry(s.yy, mean.y, mean.y), entry(s.yz, mean.y, mean.z), entry(s.zz, mean.z, mean.z)};
}

struct Scaled {
  HWY_INLINE Scaled(const Symmetric& m, Float shift0, Float scale0) noexcept
      : matrix(m), shift(shift0), scale(scale0) {}
  Symmetric matrix;
  Float shift, scale;
};

HWY_INLINE Scaled scaled(const Symmetric& m) noexcept {
  const Float shift = hn::Div(hn::Add(m.xx, hn::Add(m.yy, m.zz)), set(3.0F));
  const Symmetric shifted = m.less_diagonal(shift);
  const Float scale = greatest(greatest(greatest(hn::Abs(shifted.xx), hn::Abs(shifted.yy)),
                                        greatest(hn::Abs(shifted.zz), hn::Abs(shifted.xy))),
                               greatest(hn::Abs(shifted.xz), hn::Abs(shifted.yz)));
  const Float by = hn::IfThenElse(hn::Gt(scale, hn::Zero(Floats())), scale, set(1.0F));
  return {{hn::Div(shifted.xx, by), hn::Div(shifted.xy, by), hn::Div(shifted.xz, by),
           hn::Div(shifted.yy, by), hn::Div(shifted.yz, by), hn::Div(shifted.zz, by)},
          shift,
          scale};
}

// Of the characteristic equation; the roots follow from the third of the angle.
struct Cubic {
  HWY_INLINE explicit Cubic(const Symmetric& m) noexcept
      : c2_over_3(hn::Zero(Floats())), rho(c2_over_3), half_b(c2_over_3), root_q(c2_over_3) {
    using hn::Add;
    using hn::Mul;
    using hn::Sub;
    const Float two = set(2.0F);
    const Float third = set(1.0F / 3.0F);
    Float c0 = Add(Mul(Mul(m.xx, m.yy), m.zz), Mul(Mul(Mul(two, m.xy), m.xz), m.yz));
    c0 = Sub(c0, Mul(Mul(m.xx, m.yz), m.yz));
    c0 = Sub(c0, Mul(Mul(m.yy, m.xz), m.xz));
    c0 = Sub(c0, Mul(Mul(m.zz, m.xy), m.xy));
    Float c1 = Sub(Mul(m.xx, m.yy), Mul(m.xy, m.xy));
    c1 = Sub(Add(c1, Mul(m.xx, m.zz)), Mul(m.xz, m.xz));
    c1 = Sub(Add(c1, Mul(m.yy, m.zz)), Mul(m.yz, m.yz));
    const Float c2 = Add(Add(m.xx, m.yy), m.zz);
    c2_over_3 = Mul(c2, third);
    const Float a_over_3 = not_negative(Mul(Sub(Mul(c2, c2_over_3), c1), third));
    half_b = Mul(set(0.5F), Add(c0, Mul(c2_over_3, Sub(Mul(Mul(two, c2_over_3), c2_over_3), c1))));
    const Float q = Sub(Mul(Mul(a_over_3, a_over_3), a_over_3), Mul(half_b, half_b));
    rho = hn::Sqrt(a_over_3);
    root_q = hn::Sqrt(not_negative(q));
  }
  Float c2_over_3, rho, half_b, root_q;
};

// Increasing.
HWY_INLINE Vector roots(const Cubic& cubic, Float cosine, Float sine) noexcept {
  const Float sines = hn::Mul(set(std::sqrt(3.0F)), sine);
  return {hn::Sub(cubic.c2_over_3, hn::Mul(cubic.rho, hn::Add(cosine, sines))),
          hn::Sub(cubic.c2_over_3, hn::Mul(cubic.rho, hn::Sub(cosine, sines))),
          hn::Add(cubic.c2_over_3, hn::Mul(hn::Mul(set(2.0F), cubic.rho), cosine))};
}

// The direction that a matrix of rank 2 maps to nothing; and one of its columns, which is
// orthogonal to that.
struct Kernel {
  HWY_INLINE Kernel(const Vector& d, const Vector& c) noexcept : direction(d), column(c) {}
  Vector direction, column;
};

HWY_INLINE Kernel kernel_of(const Symmetric& m) noexcept {
  const Vector columns[3] = {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}};
  const Float first = hn::Abs(m.xx);
  const Float second = hn::Abs(m.yy);
  const Mask is_second = hn::Gt(second, first);
  const Mask is_third = hn::Gt(hn::Abs(m.zz), hn::IfThenElse(is_second, second, first));
  const auto pick = [&](const Vector& from_first, const Vector& from_second,
                        const Vector& from_third) HWY_ATTR {
    return choose(is_third, from_third, choose(is_second, from_second, from_first));
  };
  const Vector column = pick(columns[0], columns[1], columns[2]);
  const Vector c0 = cross(column, pick(columns[1], columns[2], columns[0]));
  const Vector c1 = cross(column, pick(columns[2], columns[0], columns[1]));
  const Float n0 = dot(c0, c0);
  const Float n1 = dot(c1, c1);
  const Mask is_0 = hn::Gt(n0, n1);
  return {divided(choose(is_0, c0, c1), hn::Sqrt(hn::IfThenElse(is_0, n0, n1))), column};
}

// Eigen's orthogonalisation for two eigenvalues that are numerically the same.
HWY_INLINE Vector made_orthogonal(const Vector& v, const Vector& to) noexcept {
  const Float along = dot(to, v);
  const Vector less{hn::Sub(v.x, hn::Mul(along, v.x)), hn::Sub(v.y, hn::Mul(along, v.y)),
                    hn::Sub(v.z, hn::Mul(along, v.z))};
  const Float squared = dot(less, less);
  const Mask is_something = hn::Gt(squared, hn::Zero(Floats()));
  return divided(less, hn::IfThenElse(is_something, hn::Sqrt(squared), set(1.0F)));
}

struct Axes {
  HWY_INLINE Axes(const Vector& l, const Vector& m) noexcept : least(l), most(m) {}
  Vector least, most;  // the directions of the least and the greatest extent
};

HWY_INLINE Axes axes_of(const Symmetric& m, const Vector& eigenvalues) noexcept {
  const float epsilon = std::numeric_limits<float>::epsilon();
  const Float above = hn::Sub(eigenvalues.z, eigenvalues.y);
  const Float below = hn::Sub(eigenvalues.y, eigenvalues.x);
  const Mask most_first = hn::Gt(above, below);  // its eigenvalue is the most distinct
  const Float d0 = hn::IfThenElse(most_first, below, above);
  const Kernel first =
      kernel_of(m.less_diagonal(hn::IfThenElse(most_first, eigenvalues.z, eigenvalues.x)));
  Vector second =
      kernel_of(m.less_diagonal(hn::IfThenElse(most_first, eigenvalues.x, eigenvalues.z)))
          .direction;
  const Mask are_same = hn::Le(d0, hn::Mul(set(2.0F * epsilon), below));
  if (HWY_UNLIKELY(!hn::AllFalse(Floats(), are_same))) {
    second = choose(are_same, made_orthogonal(first.column, first.direction), second);
  }
  Axes axes{choose(most_first, second, first.direction),
            choose(most_first, first.direction, second)};
  const Mask is_round = hn::Le(hn::Sub(eigenvalues.z, eigenvalues.x), set(epsilon));
  const Float one = set(1.0F);
  const Float zero = hn::Zero(Floats());
  axes.least = choose(is_round, {one, zero, zero}, axes.least);
  axes.most = choose(is_round, {zero, zero, one}, axes.most);
  return axes;
}

void take_shapes(std::span<const Around> around, ShapeColumns& shapes) {
  SpreadColumns spreads;
  for (std::size_t i = 0; i < around.size(); ++i) sum_up(around[i], spreads, i);
  const Floats df;
  const Ints di;
  Thirds thirds;
  for (std::size_t i = 0; i < kShapesAtOnce; i += hn::Lanes(df)) {
    const Cubic cubic(scaled(covariance(spreads, i)).matrix);
    hn::StoreU(cubic.half_b, df, thirds.x.data() + i);
    hn::StoreU(cubic.root_q, df, thirds.y.data() + i);
  }
  thirds.take();
  for (std::size_t i = 0; i < kShapesAtOnce; i += hn::Lanes(df)) {
    const Scaled s = scaled(covariance(spreads, i));
    const Vector eigenvalues = roots(Cubic(s.matrix), hn::LoadU(df, thirds.cosine.data() + i),
                                     hn::LoadU(df, thirds.sine.data() + i));
    const Axes axes = axes_of(s.matrix, eigenvalues);
    const auto extent2 = [&](Float eigenvalue)
                             HWY_ATTR { return hn::Add(hn::Mul(eigenvalue, s.scale), s.shift); };
    const Float least = extent2(eigenvalues.x);
    const Float middle = extent2(eigenvalues.y);
    const Mask enough = hn::Ge(hn::LoadU(df, spreads.count.data() + i), set(kFewPoints));
    const Mask is_thin = hn::And(hn::Lt(least, set(kThickness2)), enough);
    const Mask is_plane =
        hn::And(is_thin, hn::Gt(middle, hn::Mul(set(4.0F), greatest(least, set(kLeastNoise2)))));
    const Mask is_line =
        hn::And(hn::AndNot(is_plane, enough),
                hn::And(hn::Lt(middle, set(2.0F * kThickness2)),
                        hn::Gt(extent2(eigenvalues.z), hn::Mul(set(6.0F), middle))));
    const Vector direction = choose(is_plane, axes.least, axes.most);
    hn::StoreU(direction.x, df, shapes.x.data() + i);
    hn::StoreU(direction.y, df, shapes.y.data() + i);
    hn::StoreU(direction.z, df, shapes.z.data() + i);
    hn::StoreU(hn::VecFromMask(di, hn::RebindMask(di, is_plane)), di, shapes.is_plane.data() + i);
    hn::StoreU(hn::VecFromMask(di, hn::RebindMask(di, is_line)), di, shapes.is_line.data() + i);
  }
}

}  // namespace convexcut::robust::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace convexcut::robust {

// Highway's table takes no noexcept functions; none of them throws.
HWY_EXPORT(take_shapes);

void take_shapes(std::span<const Around> around, ShapeColumns& shapes) noexcept {
  HWY_DYNAMIC_DISPATCH(take_shapes)(around, shapes);
}

}  // namespace convexcut::robust
#endif
