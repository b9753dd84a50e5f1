// SPDX-License-Identifier: Apache-2.0
#include "core/scan/rotation_kernel.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
// Highway includes this file again for each instruction set.
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define HWY_TARGET_INCLUDE "core/scan/rotation_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Behind foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace convexcut::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Of `Tag`'s lanes from run.from + i on.
template <class Tag>
HWY_INLINE void rotate_lanes(Tag df, const RotatedRun& run, std::size_t i, const CloudView& from,
                             const CloudColumns& to) noexcept {
  const auto x = hn::LoadU(df, from.x.data() + run.from + i);
  const auto y = hn::LoadU(df, from.y.data() + run.from + i);
  const auto z = hn::LoadU(df, from.z.data() + run.from + i);
  const auto row = [&](std::size_t k) HWY_ATTR {
    const auto xy = hn::Add(hn::Mul(hn::Set(df, run.rotation[k]), x),
                            hn::Mul(hn::Set(df, run.rotation[k + 1]), y));
    return hn::Add(xy, hn::Mul(hn::Set(df, run.rotation[k + 2]), z));
  };
  hn::StoreU(row(0), df, to.x.data() + run.to + i);
  hn::StoreU(row(3), df, to.y.data() + run.to + i);
  hn::StoreU(row(6), df, to.z.data() + run.to + i);
}

void rotate(std::span<const RotatedRun> runs, const CloudView& from, const CloudColumns& to) {
  const hn::ScalableTag<float> df;
  const std::size_t lanes = hn::Lanes(df);
  for (const RotatedRun& run : runs) {
    std::size_t i = 0;
    // The last vector may reach into the next run, but not past the ends of the clouds.
    const std::size_t room = std::min(from.size() - run.from, to.x.size() - run.to);
    for (; i < run.count && i + lanes <= room; i += lanes) rotate_lanes(df, run, i, from, to);
    for (; i < run.count; ++i) rotate_lanes(hn::CappedTag<float, 1>(), run, i, from, to);
  }
}

}  // namespace convexcut::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace convexcut {

HWY_EXPORT(rotate);

void rotate(std::span<const RotatedRun> runs, const CloudView& from,
            const CloudColumns& to) noexcept {
  HWY_DYNAMIC_DISPATCH(rotate)(runs, from, to);
}

}  // namespace convexcut
#endif
