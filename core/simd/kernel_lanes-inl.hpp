// SPDX-License-Identifier: Apache-2.0
//
// What the kernels have in common, compiled for each instruction set: to be included behind
// <hwy/foreach_target.h>.
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "core/simd/lanes_in_front.hpp"

// Highway's guard: once for each instruction set.
#if defined(CONVEXCUT_KERNEL_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CONVEXCUT_KERNEL_LANES_INL
#undef CONVEXCUT_KERNEL_LANES_INL
#else
#define CONVEXCUT_KERNEL_LANES_INL
#endif

HWY_BEFORE_NAMESPACE();
namespace convexcut::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Words = hn::ScalableTag<std::uint32_t>;
using Float = hn::Vec<Floats>;
using Word = hn::Vec<Words>;
using Mask = hn::Mask<Floats>;

// Minimum and maximum of numbers. Highway's scalar ones ask for NaNs first, with branches.
HWY_INLINE Float least_of(Float a, Float b) noexcept {
#if HWY_TARGET == HWY_SCALAR
  return Float(a.raw < b.raw ? a.raw : b.raw);
#else
  return hn::Min(a, b);
#endif
}
HWY_INLINE Float most_of(Float a, Float b) noexcept {
#if HWY_TARGET == HWY_SCALAR
  return Float(a.raw > b.raw ? a.raw : b.raw);
#else
  return hn::Max(a, b);
#endif
}

// Of two vectors, with the bits of Eigen's, which adds three products as a + (b + c).
HWY_INLINE Float dot(Float ax, Float ay, Float az, Float bx, Float by, Float bz) noexcept {
  return hn::Add(hn::Mul(ax, bx), hn::Add(hn::Mul(ay, by), hn::Mul(az, bz)));
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

// Moves the lanes of a mask to the front of any number of vectors.
class Compressor {
 public:
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4
  // Highway 1.0's own table is copied to the stack at every use by GCC 12: four times as slow.
  HWY_INLINE explicit Compressor(Mask mask) noexcept
      : order_(
            hn::IndicesFromVec(Floats(), hn::Load(Words(), kLanesInFront[to_bits(mask)].data()))) {}
  HWY_INLINE Float operator()(Float v) const noexcept { return hn::TableLookupLanes(v, order_); }
  HWY_INLINE Word operator()(Word v) const noexcept {
    return hn::BitCast(Words(), (*this)(hn::BitCast(Floats(), v)));
  }

 private:
  decltype(hn::IndicesFromVec(Floats(), Word())) order_;
#else
  HWY_INLINE explicit Compressor(Mask mask) noexcept : mask_(mask) {}
  HWY_INLINE Float operator()(Float v) const noexcept { return hn::Compress(v, mask_); }
  HWY_INLINE Word operator()(Word v) const noexcept {
    return hn::Compress(v, hn::RebindMask(Words(), mask_));
  }

 private:
  Mask mask_;
#endif
};

// The number of an item takes the place of a value's lowest mantissa bits, as few as are needed:
// one maximum finds both. That only makes the choice a little worse.
HWY_INLINE Float tagged(Float value, Word tag, Word keep) noexcept {
  return hn::BitCast(Floats(), hn::OrAnd(tag, hn::BitCast(Words(), value), keep));
}

}  // namespace convexcut::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per target
