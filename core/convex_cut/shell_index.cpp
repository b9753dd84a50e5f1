// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/shell_index.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/convex_cut/cloud_kernels.hpp"
#include "core/convex_cut/direction.hpp"
#include "core/convex_cut/parameters.hpp"

namespace convexcut {
namespace {

constexpr std::size_t kKeys = ShellIndex::kShells * ShellIndex::kBuckets;
static_assert(kKeys <= 0x1'0000, "a key is 16 bits wide");

// Windows are this much wider than exact arithmetic asks for, in units of the turn below and
// relative to the radius: a hundred times the rounding of the float keys.
constexpr double kTurnSlack = 1e-4;
constexpr double kRadiusSlack = 1e-5;

// Of a shell, where those of the four quarter turns are cut by its end.
constexpr std::size_t kQuarters = 4;
constexpr std::size_t kMostRuns = (kQuarters + 1) * ShellIndex::kShells;

// The columns of more points than this, 8 MB, are not in a cache any more when they are read.
constexpr std::size_t kMostInCache = std::size_t{1} << 19U;

// Points that are counted at once, a fourth of them at each of four places: a dense cloud's places
// are then in different buckets, and not whole pages apart, where they would share sets of the
// first cache.
constexpr std::size_t kCountedAtOnce = 4 * std::size_t{8192 + 64};

// How many points of its key each point comes after. Points that follow each other often have the
// same key and would wait for each other's count: so they are counted in turn at four places.
void rank_points(const std::uint16_t* keys, std::size_t size, std::uint32_t* counts,
                 std::uint32_t* ranks) noexcept {
  const std::size_t quarter = size / 4;
  for (std::size_t i = 0; i < quarter; ++i) {
    ranks[i] = counts[keys[i]]++;
    ranks[i + quarter] = counts[keys[i + quarter]]++;
    ranks[i + 2 * quarter] = counts[keys[i + 2 * quarter]]++;
    ranks[i + 3 * quarter] = counts[keys[i + 3 * quarter]]++;
  }
  for (std::size_t i = 4 * quarter; i < size; ++i) ranks[i] = counts[keys[i]]++;
}

}  // namespace

ShellIndex::ShellIndex(double half_width_m, std::size_t max_points, unsigned threads)
    : inverse_squared_half_width_(static_cast<float>(1.0 / (half_width_m * half_width_m))),
      parts_(std::max(threads, 1U)),
      keys_(max_points + kKernelPadding),
      ranks_(max_points + kKernelPadding),
      records_(max_points + kKernelPadding, 0),
      x_(max_points + kKernelPadding, 1),
      y_(max_points + kKernelPadding, 2),
      z_(max_points + kKernelPadding, 3),
      source_(max_points + kKernelPadding, 4),
      starts_(kKeys + 1),
      strip_starts_(kStrips + 1),
      runs_(kMostRuns),
      pieces_(max_points / kChunk + 1 + kMostRuns) {
  for (Part& part : parts_) part.counts.resize(kKeys);
  for (std::size_t shell = 0; shell < kShells; ++shell) {
    // u² = r² − v², and |v| < d.
    const double squared_d = half_width_m * half_width_m;
    const double inner = std::ldexp(squared_d, static_cast<int>(shell)) * (1.0 - kRadiusSlack);
    const double outer = std::ldexp(squared_d, static_cast<int>(shell) + 1) * (1.0 + kRadiusSlack);
    const double least_u = std::sqrt(std::max(inner - squared_d, 0.0)) * (1.0 - kRadiusSlack);
    least_u_m_[shell] = static_cast<float>(least_u);
    most_u_m_[shell] = static_cast<float>(std::sqrt(outer) * (1.0 + kRadiusSlack));
  }
  most_u_m_.back() = std::numeric_limits<float>::max();
}

void ShellIndex::build(const CloudView& cloud) noexcept {
  begin(cloud);
  for (std::size_t part = 0; part < parts(); ++part) static_cast<void>(count(part));
  lay_out();
  for (std::size_t run = 0; run < runs().count; ++run) number_keys(run);
  for (std::size_t part = 0; part < parts(); ++part) place(part);
  for (std::size_t k = 0; k < pieces().count; ++k) spread(k);
}

void ShellIndex::begin(const CloudView& cloud) noexcept {
  cloud_ = cloud;
  size_ = cloud.size();
  const std::size_t shares = 2 * parts_.size();
  const auto share_begin = [this, shares](std::size_t k) {
    return static_cast<std::uint32_t>(size_ * k / shares);
  };
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const std::size_t opposite = k + parts_.size();
    parts_[k].points = {Range{share_begin(k), share_begin(k + 1)},
                        Range{share_begin(opposite), share_begin(opposite + 1)}};
  }
}

std::uint32_t ShellIndex::count(std::size_t part_number) noexcept {
  Part& part = parts_[part_number];
  part.bounds = {};
  std::fill_n(part.counts.data(), kKeys, 0U);
  for (const Range& points : part.points) count_points(part, points);
  part.strip_counts.fill(0);
  const std::size_t end = (part.bounds.greatest / kBuckets + 1) * kStripsOfShell;
  for (std::size_t k = part.bounds.least / kBuckets * kStripsOfShell; k < end; ++k) {
    const std::uint32_t* const counts = part.counts.data() + k * kStripBuckets;
    part.strip_counts[k] = std::accumulate(counts, counts + kStripBuckets, 0U);
  }
  return part.bounds.magnitude_bits;
}

void ShellIndex::count_points(Part& part, Range points) noexcept {
  for (std::size_t begin = points.begin; begin < points.end; begin += kCountedAtOnce) {
    const std::size_t end = std::min<std::size_t>(begin + kCountedAtOnce, points.end);
    const KeyBounds bounds =
        shell_keys(cloud_, begin, end, inverse_squared_half_width_, keys_.data());
    part.bounds.magnitude_bits = std::max(part.bounds.magnitude_bits, bounds.magnitude_bits);
    if (bounds.magnitude_bits > std::bit_cast<std::uint32_t>(kMaxCoordinateM)) return;
    part.bounds.least = std::min(part.bounds.least, bounds.least);
    part.bounds.greatest = std::max(part.bounds.greatest, bounds.greatest);
    rank_points(keys_.data() + begin, end - begin, part.counts.data(), ranks_.data() + begin);
  }
}

// Touches nothing that is as long as the keys: another thread's counts would have to come from its
// cache.
void ShellIndex::lay_out() noexcept {
  KeyBounds bounds;
  for (const Part& part : parts_) {
    bounds.least = std::min(bounds.least, part.bounds.least);
    bounds.greatest = std::max(bounds.greatest, part.bounds.greatest);
  }
  used_shell_count_ = 0;
  run_shares_ = {};
  piece_shares_ = {};
  if (size_ == 0) return;
  const std::size_t least_shell = bounds.least / kBuckets;
  const std::size_t greatest_shell = bounds.greatest / kBuckets;
  std::uint32_t begin = 0;
  for (std::size_t shell = least_shell; shell <= greatest_shell; ++shell) {
    const std::uint32_t shell_begin = begin;
    for (std::size_t k = shell * kStripsOfShell; k < (shell + 1) * kStripsOfShell; ++k) {
      strip_starts_[k] = begin;
      for (const Part& part : parts_) begin += part.strip_counts[k];
    }
    if (begin != shell_begin) used_shells_[used_shell_count_++] = shell;
  }
  strip_starts_[(greatest_shell + 1) * kStripsOfShell] = begin;
  starts_[(greatest_shell + 1) * kBuckets] = begin;
  lay_out_runs(least_shell, greatest_shell);
}

// The quarter turns begin where the first point is.
void ShellIndex::lay_out_runs(std::size_t least_shell, std::size_t greatest_shell) noexcept {
  constexpr std::size_t kStripsOfQuarter = kStripsOfShell / kQuarters;
  const std::size_t first = keys_[0] % kBuckets;
  const std::size_t later = keys_[size_ / 8] % kBuckets;
  const std::size_t turned = (later + kBuckets - first) % kBuckets;
  const bool turns_left = turned < kBuckets / 2;
  const std::size_t nearest = (first + kStripBuckets / 2) / kStripBuckets;
  front_strip_ = (nearest + (turns_left ? 0 : kStripsOfShell - kStripsOfQuarter)) % kStripsOfShell;
  for (const std::size_t quarter : {0U, 2U, 1U, 3U}) {
    const std::size_t from = (front_strip_ + quarter * kStripsOfQuarter) % kStripsOfShell;
    const std::size_t to = from + kStripsOfQuarter;
    for (std::size_t shell = least_shell; shell <= greatest_shell; ++shell) {
      const std::size_t begin = shell * kStripsOfShell;
      const std::size_t end = begin + kStripsOfShell;
      add_run(begin + from, std::min(begin + to, end));
      if (to > kStripsOfShell) add_run(begin, begin + to - kStripsOfShell);
    }
    if (quarter == 2) {
      run_shares_.in_front = run_shares_.count;
      piece_shares_.in_front = piece_shares_.count;
    }
  }
}

void ShellIndex::add_run(std::size_t begin, std::size_t end) noexcept {
  runs_[run_shares_.count++] = {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
  add_pieces(strip_starts_[begin], strip_starts_[end]);
}

void ShellIndex::number_keys(std::size_t run) noexcept {
  for (std::size_t strip = runs_[run].begin; strip < runs_[run].end; ++strip) {
    const std::size_t first = strip * kStripBuckets;
    const std::uint32_t start = strip_starts_[strip];
    // Empty, as most are where the points are in a few directions.
    if (start == strip_starts_[strip + 1]) {
      std::fill_n(starts_.data() + first, kStripBuckets, start);
      continue;
    }
    std::array<std::uint32_t, kStripBuckets> places{};
    // The counts of a part without points here stay in its thread's cache.
    const auto for_each_part = [&](auto&& visit) {
      for (Part& part : parts_) {
        if (part.strip_counts[strip] == 0) continue;
        std::uint32_t* const counts = part.counts.data() + first;
        for (std::size_t k = 0; k < kStripBuckets; ++k) visit(places[k], counts[k]);
      }
    };
    for_each_part([](std::uint32_t& sum, std::uint32_t count) { sum += count; });
    std::exclusive_scan(places.begin(), places.end(), places.begin(), start);
    std::ranges::copy(places, starts_.data() + first);
    for_each_part(
        [](std::uint32_t& next, std::uint32_t& count) { next += std::exchange(count, next); });
  }
}

// Whole lines of the cache, so that no two pieces share one.
void ShellIndex::add_pieces(std::uint32_t begin, std::uint32_t end) noexcept {
  const auto at_line = [this](std::uint32_t position) {
    constexpr std::uint32_t kWholeLines = 64;
    return position == size_ ? position : position / kWholeLines * kWholeLines;
  };
  const std::uint32_t last = at_line(end);
  for (std::uint32_t next = at_line(begin); next < last;) {
    const std::uint32_t piece_end = std::min<std::uint32_t>(next + kChunk, last);
    pieces_[piece_shares_.count++] = {next, piece_end};
    next = piece_end;
  }
}

void ShellIndex::place(std::size_t part_number) noexcept {
  const Part& part = parts_[part_number];
  for (const Range& points : part.points) {
    place_points(cloud_, keys_.data(), ranks_.data(), points.begin, points.end, part.counts.data(),
                 records_.data());
  }
}

void ShellIndex::spread(std::size_t piece_number) noexcept {
  const Range range = piece(piece_number);
  spread_records(records_.data(), range.begin, range.end,
                 {x_.data(), y_.data(), z_.data(), source_.data()}, size_ > kMostInCache);
}

ShellIndex::Windows ShellIndex::windows(const SlicingPlane& plane) noexcept {
  constexpr double kBucketsPerUnit = static_cast<double>(kBuckets) / kTurn<double>;
  constexpr auto kAllBuckets = static_cast<std::int64_t>(kBuckets);
  Windows windows;
  for (std::size_t shell = 1; shell < kShells; ++shell) {
    const double sine = std::exp2(-0.5 * static_cast<double>(shell)) * (1.0 + kRadiusSlack);
    const double cosine = std::sqrt(1.0 - sine * sine);
    // The plane's direction turned by ∓asin(d/r).
    const double from = direction(plane.cos_theta * cosine + plane.sin_theta * sine,
                                  plane.sin_theta * cosine - plane.cos_theta * sine);
    double to = direction(plane.cos_theta * cosine - plane.sin_theta * sine,
                          plane.sin_theta * cosine + plane.cos_theta * sine);
    if (to < from) to += kTurn<double>;
    const auto first = static_cast<std::int64_t>(std::floor((from - kTurnSlack) * kBucketsPerUnit));
    const auto last = static_cast<std::int64_t>(std::floor((to + kTurnSlack) * kBucketsPerUnit));
    windows[shell] = {static_cast<std::uint16_t>((first + kAllBuckets) % kAllBuckets),
                      static_cast<std::uint16_t>(std::min(last - first + 1, kAllBuckets))};
  }
  return windows;
}

}  // namespace convexcut
