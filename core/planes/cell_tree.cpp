// SPDX-License-Identifier: Apache-2.0
#include "core/planes/cell_tree.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace convexcut {
namespace {

constexpr std::int64_t kMostCells = std::int64_t{1} << 20U;  // on each side of the origin
constexpr unsigned kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;

// Bit i of a number goes to bit 3·i (Morton order).
[[nodiscard]] constexpr std::uint64_t spread_bits(std::uint64_t v) noexcept {
  v &= 0x1F'FFFF;
  v = (v | v << 32U) & 0x001F'0000'0000'FFFF;
  v = (v | v << 16U) & 0x001F'0000'FF00'00FF;
  v = (v | v << 8U) & 0x100F'00F0'0F00'F00F;
  v = (v | v << 4U) & 0x10C3'0C30'C30C'30C3;
  v = (v | v << 2U) & 0x1249'2492'4924'9249;
  return v;
}
[[nodiscard]] constexpr std::uint32_t gather_bits(std::uint64_t v) noexcept {
  v &= 0x1249'2492'4924'9249;
  v = (v | v >> 2U) & 0x10C3'0C30'C30C'30C3;
  v = (v | v >> 4U) & 0x100F'00F0'0F00'F00F;
  v = (v | v >> 8U) & 0x001F'0000'FF00'00FF;
  v = (v | v >> 16U) & 0x001F'0000'0000'FFFF;
  v = (v | v >> 32U) & 0x1F'FFFF;
  return static_cast<std::uint32_t>(v);
}
static_assert(gather_bits(spread_bits(0x15'5AA7)) == 0x15'5AA7);

using Grid = std::array<std::int64_t, 3>;

}  // namespace

CellTree::CellTree(const PlaneOptions& options)
    : cell_m_(options.largest_cell_m / static_cast<double>(1U << options.levels)),
      levels_(options.levels) {}

CellTree::Cell CellTree::cell_of(std::uint64_t key) noexcept {
  return {gather_bits(key), gather_bits(key >> 1U), gather_bits(key >> 2U)};
}

std::uint64_t CellTree::key_of(const Cell& cell) noexcept {
  return spread_bits(cell.x) | spread_bits(cell.y) << 1U | spread_bits(cell.z) << 2U;
}

void CellTree::take_entries(const CloudView& cloud) {
  const double most = static_cast<double>(kMostCells - 1) * cell_m_;
  const auto usable = [most](float value) { return std::abs(static_cast<double>(value)) <= most; };
  const auto grid = [this](float value) {
    return static_cast<std::int64_t>(std::floor(static_cast<double>(value) / cell_m_)) + kMostCells;
  };
  Grid low{2 * kMostCells, 2 * kMostCells, 2 * kMostCells};
  entries_.clear();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!usable(cloud.x[i]) || !usable(cloud.y[i]) || !usable(cloud.z[i])) continue;
    low = {std::min(low[0], grid(cloud.x[i])), std::min(low[1], grid(cloud.y[i])),
           std::min(low[2], grid(cloud.z[i]))};
    entries_.push_back({0, static_cast<std::uint32_t>(i)});
  }
  // Keys count from the largest cell that holds the lowest corner: the grid stays where it is, and
  // keys are short.
  for (std::int64_t& at : low) at = (at >> levels_) << levels_;
  std::uint64_t all_bits = 0;
  for (Entry& entry : entries_) {
    const auto offset = [&](float value, std::size_t axis) {
      return static_cast<std::uint32_t>(grid(value) - low[axis]);
    };
    entry.key = key_of({offset(cloud.x[entry.index], 0), offset(cloud.y[entry.index], 1),
                        offset(cloud.z[entry.index], 2)});
    all_bits |= entry.key;
  }
  key_bits_ = static_cast<unsigned>(std::bit_width(all_bits));
}

// Stable, digit by digit from the lowest.
void CellTree::sort_entries() {
  spare_.resize(entries_.size());
  for (unsigned shift = 0; shift < key_bits_; shift += kDigitBits) {
    std::array<std::uint32_t, kDigits> next{};
    const auto digit = [shift](const Entry& entry) {
      return static_cast<std::size_t>(entry.key >> shift) % kDigits;
    };
    for (const Entry& entry : entries_) ++next[digit(entry)];
    std::uint32_t sum = 0;
    for (std::uint32_t& count : next) sum += std::exchange(count, sum);
    for (const Entry& entry : entries_) spare_[next[digit(entry)]++] = entry;
    entries_.swap(spare_);
  }
}

void CellTree::build(const CloudView& cloud) {
  take_entries(cloud);
  sort_entries();
  keys_.resize(entries_.size());
  index_.resize(entries_.size());
  x_.resize(entries_.size());
  y_.resize(entries_.size());
  z_.resize(entries_.size());
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const std::uint32_t from = entries_[i].index;
    keys_[i] = entries_[i].key;
    index_[i] = from;
    x_[i] = cloud.x[from];
    y_[i] = cloud.y[from];
    z_[i] = cloud.z[from];
  }
}

CellTree::Range CellTree::cell_at(std::uint32_t begin, std::uint32_t end,
                                  std::uint32_t level) const noexcept {
  const std::uint64_t next = (key(begin, level) + 1) << (3U * level);
  const auto* const keys = keys_.data();
  const auto* const stop = std::lower_bound(keys + begin, keys + end, next);
  return {begin, static_cast<std::uint32_t>(stop - keys)};
}

}  // namespace convexcut
