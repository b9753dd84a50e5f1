// SPDX-License-Identifier: Apache-2.0
//
// How durations are distributed, in fixed memory and at a constant relative error. The buckets are
// those of HdrHistogram (http://hdrhistogram.org): linear within a power of two, each power of two
// twice as wide as the one before.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/counter.hpp"
#include "core/time.hpp"

namespace convexcut {

// One writing thread, any number of reading ones, which see a moment of a histogram that goes on
// filling. Nothing allocates, locks or calls the system.
//
// What is read back differs from what was recorded by at most 1/64 (1.6 %) from kFinest up to
// kLongest, and by at most 16 ns below kFinest. Longer durations count as kLongest; negative ones,
// which a clock that was stepped back gives, as zero.
class LatencyHistogram {
 public:
  static constexpr Duration kFinest{1 << 10};                        // 1.024 µs
  static constexpr Duration kLongest{(std::int64_t{1} << 36U) - 1};  // 68.7 s

  // Writer thread. RT.
  void record(Duration duration) noexcept {
    const auto ns =
        static_cast<std::uint64_t>(std::clamp(duration, Duration::zero(), kLongest).count());
    buckets_[bucket_of(ns)].add();
    total_ns_.add(ns);
    // One writer: a plain load and store. Relaxed: pairs with the load in max(), orders nothing.
    if (ns > max_ns_.load(std::memory_order_relaxed)) {
      max_ns_.store(ns, std::memory_order_relaxed);
    }
  }

  [[nodiscard]] std::uint64_t count() const noexcept {
    std::uint64_t sum = 0;
    for (const Counter& bucket : buckets_) sum += bucket.value();
    return sum;
  }

  // The duration that `percent` (0 … 100) of those recorded do not exceed (nearest rank), to the
  // error above; zero when nothing was recorded. percentile(100) is max().
  [[nodiscard]] Duration percentile(double percent) const noexcept {
    const std::uint64_t recorded = count();
    if (recorded == 0) return Duration::zero();
    const double share = std::clamp(percent, 0.0, 100.0) / 100.0;
    const auto rank = static_cast<std::uint64_t>(
        std::ceil(share * static_cast<double>(recorded) * (1.0 - kRounding)));
    if (rank >= recorded) return max();
    // Buckets only grow, so the second pass reaches the rank even while the writer goes on.
    std::uint64_t seen = 0;
    for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
      seen += buckets_[bucket].value();
      if (seen >= std::max<std::uint64_t>(rank, 1)) return std::min(middle_of(bucket), max());
    }
    return max();
  }

  // The longest, exactly (up to kLongest); zero when nothing was recorded.
  [[nodiscard]] Duration max() const noexcept {
    // Relaxed: pairs with the store in record().
    return Duration{static_cast<Duration::rep>(max_ns_.load(std::memory_order_relaxed))};
  }

  // The sum of all, exactly, for 290 years.
  [[nodiscard]] Duration total() const noexcept {
    return Duration{static_cast<Duration::rep>(total_ns_.value())};
  }

  [[nodiscard]] Duration mean() const noexcept {
    const std::uint64_t recorded = count();
    return recorded == 0 ? Duration::zero() : total() / static_cast<std::int64_t>(recorded);
  }

 private:
  static constexpr unsigned kSubBits = 5;  // 32 buckets a power of two: each 1/32 of its start wide
  static constexpr std::size_t kPerOctave = std::size_t{1} << kSubBits;
  static constexpr unsigned kFirstOctave = 10;
  static_assert(kFinest.count() == 1 << kFirstOctave);
  static constexpr unsigned kUnitBits = kFirstOctave - kSubBits;
  static constexpr unsigned kEndOctave =
      std::bit_width(static_cast<std::uint64_t>(kLongest.count()));
  // Below the first octave, as many buckets of the same width as it has.
  static constexpr std::size_t kBuckets = (kEndOctave - kFirstOctave + 1) * kPerOctave;
  // Of the product above, so that 99 % of 100 is the 99th and not the 100th.
  static constexpr double kRounding = 1e-15;

  [[nodiscard]] static constexpr std::size_t bucket_of(std::uint64_t ns) noexcept {
    const unsigned octave =
        std::max(static_cast<unsigned>(std::bit_width(ns)), kFirstOctave + 1) - 1;
    return (octave - kFirstOctave) * kPerOctave + (ns >> (octave - kSubBits));
  }
  [[nodiscard]] static constexpr Duration middle_of(std::size_t bucket) noexcept {
    const std::size_t doublings = bucket < 2 * kPerOctave ? 0 : bucket / kPerOctave - 1;
    const std::uint64_t width = std::uint64_t{1} << (kUnitBits + doublings);
    const std::uint64_t begin = (bucket - doublings * kPerOctave) * width;
    return Duration{static_cast<Duration::rep>(begin + width / 2)};
  }

  std::array<Counter, kBuckets> buckets_{};
  Counter total_ns_;
  std::atomic<std::uint64_t> max_ns_{0};
};

}  // namespace convexcut
