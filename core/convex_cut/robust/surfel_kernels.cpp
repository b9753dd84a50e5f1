// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/surfel_kernels.hpp"

#include <array>

#undef HWY_TARGET_INCLUDE
// Highway includes this file again for each instruction set.
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define HWY_TARGET_INCLUDE "core/convex_cut/robust/surfel_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Behind foreach_target.h.
#include "core/simd/kernel_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace convexcut::robust::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace lanes_of = convexcut::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Words = hn::ScalableTag<std::uint32_t>;
using Float = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;

// The tests of a plane on the surfels from i on.
class PlaneTest {
 public:
  HWY_INLINE PlaneTest(const SurfelColumns& surfels, const Plane& plane, float gate_m) noexcept
      : x_(hn::Set(Floats(), plane.normal.x())),
        y_(hn::Set(Floats(), plane.normal.y())),
        z_(hn::Set(Floats(), plane.normal.z())),
        offset_(hn::Set(Floats(), plane.offset)),
        gate_(hn::Set(Floats(), gate_m)) {
    for (std::size_t c = 0; c <= SurfelColumns::kBar; ++c) at_[c] = surfels.column(c);
  }
  HWY_INLINE Float height(std::size_t i) const noexcept {
    return hn::Abs(hn::Add(lanes_of::dot(x_, y_, z_, load(SurfelColumns::kX, i),
                                         load(SurfelColumns::kY, i), load(SurfelColumns::kZ, i)),
                           offset_));
  }
  HWY_INLINE Mask is_near(std::size_t i) const noexcept { return hn::Lt(height(i), gate_); }
  HWY_INLINE Mask agrees(std::size_t i) const noexcept {
    const Float bar = load(SurfelColumns::kBar, i);
    const Float cosine = lanes_of::dot(x_, y_, z_, load(SurfelColumns::kU, i),
                                       load(SurfelColumns::kV, i), load(SurfelColumns::kW, i));
    return hn::And(hn::Le(height(i), gate_), hn::Gt(hn::CopySign(cosine, bar), bar));
  }

 private:
  HWY_INLINE Float load(std::size_t column, std::size_t i) const noexcept {
    return hn::LoadU(Floats(), at_[column] + i);
  }
  Float x_, y_, z_, offset_, gate_;
  std::array<const float*, SurfelColumns::kBar + 1> at_;
};

// Of the lanes from i on, those before the end.
HWY_INLINE Mask before_end(std::size_t i, std::size_t end) noexcept {
  return hn::FirstN(Floats(), end - i);
}

AgreeingCounts count_agreeing(const SurfelColumns& surfels,
                              const std::array<Plane, kPlanesAtOnce>& planes, float gate_m) {
  const Floats df;
  const std::size_t lanes = hn::Lanes(df);
  const std::array<PlaneTest, kPlanesAtOnce> tests{
      PlaneTest(surfels, planes[0], gate_m), PlaneTest(surfels, planes[1], gate_m),
      PlaneTest(surfels, planes[2], gate_m), PlaneTest(surfels, planes[3], gate_m)};
  AgreeingCounts counts{};
  std::size_t i = 0;
  for (; i + lanes <= surfels.size; i += lanes) {
    for (std::size_t k = 0; k < kPlanesAtOnce; ++k) {
      counts[k] += hn::CountTrue(df, tests[k].agrees(i));
    }
  }
  if (i == surfels.size) return counts;
  const Mask valid = before_end(i, surfels.size);
  for (std::size_t k = 0; k < kPlanesAtOnce; ++k) {
    counts[k] += hn::CountTrue(df, hn::And(tests[k].agrees(i), valid));
  }
  return counts;
}

void mark_agreeing(const SurfelColumns& surfels, const Plane& plane, float gate_m,
                   std::span<std::uint64_t> bits) {
  constexpr std::size_t kBits = 64;
  const std::size_t lanes = hn::Lanes(Floats());
  const PlaneTest test(surfels, plane, gate_m);
  for (std::size_t word = 0; word * kBits < surfels.size; ++word) {
    bits[word] = 0;
    const std::size_t begin = word * kBits;
    for (std::size_t i = begin; i < begin + kBits && i < surfels.size; i += lanes) {
      const Mask agree = hn::And(test.agrees(i), before_end(i, surfels.size));
      bits[word] |= lanes_of::to_bits(agree) << (i - begin);
    }
  }
}

// Copies the lanes of a mask, of each column, to the front of others.
HWY_INLINE void move(const SurfelColumns& from, std::size_t i, Mask which, SurfelColumns& to,
                     std::size_t at) noexcept {
  const lanes_of::Compressor compress(which);
  for (std::size_t c = 0; c < SurfelColumns::kColumns; ++c) {
    hn::StoreU(compress(hn::LoadU(Floats(), from.column(c) + i)), Floats(), to.column(c) + at);
  }
  hn::StoreU(compress(hn::LoadU(Words(), from.index.data() + i)), Words(), to.index.data() + at);
}

void copy_near(const SurfelColumns& surfels, const Plane& plane, float reach_m,
               SurfelColumns& near) {
  const Floats df;
  const PlaneTest test(surfels, plane, reach_m);
  near.size = 0;
  for (std::size_t i = 0; i < surfels.size; i += hn::Lanes(df)) {
    const Mask is_near = hn::And(test.is_near(i), before_end(i, surfels.size));
    if (hn::AllFalse(df, is_near)) continue;
    move(surfels, i, is_near, near, near.size);
    near.size += hn::CountTrue(df, is_near);
  }
}

std::size_t take_agreeing(SurfelColumns& surfels, const Plane& plane, float gate_m,
                          std::uint32_t* taken) {
  const Floats df;
  const PlaneTest test(surfels, plane, gate_m);
  std::size_t kept = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < surfels.size; i += hn::Lanes(df)) {
    const Mask valid = before_end(i, surfels.size);
    const Mask agree = hn::And(test.agrees(i), valid);
    const Mask others = hn::AndNot(agree, valid);
    hn::StoreU(lanes_of::Compressor(agree)(hn::LoadU(Words(), surfels.index.data() + i)), Words(),
               taken + count);
    move(surfels, i, others, surfels, kept);
    count += hn::CountTrue(df, agree);
    kept += hn::CountTrue(df, others);
  }
  surfels.size = kept;
  return count;
}

}  // namespace convexcut::robust::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace convexcut::robust {

// Highway's table takes no noexcept functions; none of them throws.
HWY_EXPORT(count_agreeing);
HWY_EXPORT(mark_agreeing);
HWY_EXPORT(copy_near);
HWY_EXPORT(take_agreeing);

AgreeingCounts count_agreeing(const SurfelColumns& surfels,
                              const std::array<Plane, kPlanesAtOnce>& planes,
                              float gate_m) noexcept {
  return HWY_DYNAMIC_DISPATCH(count_agreeing)(surfels, planes, gate_m);
}

void mark_agreeing(const SurfelColumns& surfels, const Plane& plane, float gate_m,
                   std::span<std::uint64_t> bits) noexcept {
  HWY_DYNAMIC_DISPATCH(mark_agreeing)(surfels, plane, gate_m, bits);
}

void copy_near(const SurfelColumns& surfels, const Plane& plane, float reach_m,
               SurfelColumns& near) noexcept {
  HWY_DYNAMIC_DISPATCH(copy_near)(surfels, plane, reach_m, near);
}

std::size_t take_agreeing(SurfelColumns& surfels, const Plane& plane, float gate_m,
                          std::uint32_t* taken) noexcept {
  return HWY_DYNAMIC_DISPATCH(take_agreeing)(surfels, plane, gate_m, taken);
}

}  // namespace convexcut::robust
#endif
