// SPDX-License-Identifier: Apache-2.0
//
// Moves chosen lanes of vectors to the front. Included once for each instruction set: below
// foreach_target.h, which asks for that by toggling the macro.
#if defined(CONVEXCUT_CORE_SIMD_COMPRESSOR_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CONVEXCUT_CORE_SIMD_COMPRESSOR_INL
#undef CONVEXCUT_CORE_SIMD_COMPRESSOR_INL
#else
#define CONVEXCUT_CORE_SIMD_COMPRESSOR_INL
#endif

#include <cstdint>

#include <hwy/highway.h>

#include "core/simd/lanes_in_front.hpp"

HWY_BEFORE_NAMESPACE();
namespace convexcut::HWY_NAMESPACE {

// The lanes of a mask as bits, the first lane lowest.
HWY_INLINE std::uint64_t to_bits(
    hwy::HWY_NAMESPACE::Mask<hwy::HWY_NAMESPACE::ScalableTag<float>> mask) noexcept {
  std::uint64_t bits = 0;
  std::uint8_t bytes[8] = {};
  hwy::HWY_NAMESPACE::StoreMaskBits(hwy::HWY_NAMESPACE::ScalableTag<float>(), mask, bytes);
  for (unsigned i = 8; i-- > 0;) bits = (bits << 8U) | bytes[i];
  return bits;
}

// Moves the lanes of one mask to the front of any number of vectors; what is behind is undefined.
class Compressor {
  using Floats = hwy::HWY_NAMESPACE::ScalableTag<float>;
  using Words = hwy::HWY_NAMESPACE::ScalableTag<std::uint32_t>;
  using Float = hwy::HWY_NAMESPACE::Vec<Floats>;
  using Word = hwy::HWY_NAMESPACE::Vec<Words>;
  using Mask = hwy::HWY_NAMESPACE::Mask<Floats>;

 public:
#if HWY_TARGET == HWY_AVX2
  // Highway 1.0's own table is copied to the stack at every use by GCC 12: four times as slow.
  HWY_INLINE explicit Compressor(Mask mask) noexcept
      : order_(hwy::HWY_NAMESPACE::IndicesFromVec(
            Floats(),
            hwy::HWY_NAMESPACE::Load(Words(), kLanesInFront[to_bits(mask)].data()))) {}
  HWY_INLINE Float operator()(Float v) const noexcept {
    return hwy::HWY_NAMESPACE::TableLookupLanes(v, order_);
  }
  HWY_INLINE Word operator()(Word v) const noexcept {
    return hwy::HWY_NAMESPACE::BitCast(
        Words(), (*this)(hwy::HWY_NAMESPACE::BitCast(Floats(), v)));
  }

 private:
  decltype(hwy::HWY_NAMESPACE::IndicesFromVec(Floats(), Word())) order_;
#else
  HWY_INLINE explicit Compressor(Mask mask) noexcept : mask_(mask) {}
  HWY_INLINE Float operator()(Float v) const noexcept {
    return hwy::HWY_NAMESPACE::Compress(v, mask_);
  }
  HWY_INLINE Word operator()(Word v) const noexcept {
    return hwy::HWY_NAMESPACE::Compress(v,
                                        hwy::HWY_NAMESPACE::RebindMask(Words(), mask_));
  }

 private:
  Mask mask_;
#endif
};

}  // namespace convexcut::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
