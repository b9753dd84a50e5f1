// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/voxel_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace convexcut::robust {
namespace {

constexpr std::int32_t kBias = 1 << 20;
constexpr unsigned kBits = 21;
constexpr VoxelKey kMask = (VoxelKey{1} << kBits) - 1;

}  // namespace

VoxelKey key_of(const Lattice& place) noexcept {
  const auto part = [](std::int32_t c) { return static_cast<VoxelKey>(c + kBias) & kMask; };
  return (part(place[0]) << (2 * kBits)) | (part(place[1]) << kBits) | part(place[2]);
}

Lattice place_of(VoxelKey key) noexcept {
  const auto part = [](VoxelKey bits) { return static_cast<std::int32_t>(bits & kMask) - kBias; };
  return {part(key >> (2 * kBits)), part(key >> kBits), part(key)};
}

Lattice place_of(const Vec3f& point) noexcept {
  // Far outside of the lattice all is one border: such points have no neighbours to agree with.
  const auto step = [](float c) {
    constexpr auto kLimit = static_cast<float>(kBias - 2);
    return static_cast<std::int32_t>(std::clamp(std::floor(c / kVoxelM), -kLimit, kLimit));
  };
  return {step(point.x()), step(point.y()), step(point.z())};
}

Vec3f centre_of(const Lattice& place) noexcept {
  const auto middle = [](std::int32_t c) { return (static_cast<float>(c) + 0.5F) * kVoxelM; };
  return {middle(place[0]), middle(place[1]), middle(place[2])};
}

VoxelMap::VoxelMap(std::size_t capacity)
    : slots_(std::bit_ceil(std::max<std::size_t>(2 * capacity, 2)), kNone) {
  voxels_.reserve(capacity);
}

void VoxelMap::clear() noexcept {
  std::fill(slots_.begin(), slots_.end(), kNone);
  voxels_.clear();
}

std::size_t VoxelMap::home_of(VoxelKey key) const noexcept {
  constexpr VoxelKey kGolden = 0x9E3779B97F4A7C15U;  // Fibonacci hashing (Knuth, vol. 3, 6.4)
  return static_cast<std::size_t>((key * kGolden) >> 32U) & (slots_.size() - 1);
}

std::int32_t VoxelMap::find(VoxelKey key) const noexcept {
  for (std::size_t i = home_of(key);; i = (i + 1) & (slots_.size() - 1)) {
    const std::int32_t index = slots_[i];
    if (index == kNone || voxels_[static_cast<std::size_t>(index)].key == key) return index;
  }
}

std::int32_t VoxelMap::find_or_add(VoxelKey key) noexcept {
  std::size_t i = home_of(key);
  for (; slots_[i] != kNone; i = (i + 1) & (slots_.size() - 1)) {
    if (voxels_[static_cast<std::size_t>(slots_[i])].key == key) return slots_[i];
  }
  if (voxels_.size() == voxels_.capacity()) return kNone;
  slots_[i] = static_cast<std::int32_t>(voxels_.size());
  voxels_.emplace_back().key = key;
  return slots_[i];
}

void VoxelMap::remove_empty() noexcept {
  std::size_t kept = 0;
  for (const Voxel& voxel : voxels_) {
    if (voxel.moments.count > 0) voxels_[kept++] = voxel;
  }
  if (kept == voxels_.size()) return;
  voxels_.resize(kept);
  std::fill(slots_.begin(), slots_.end(), kNone);
  for (std::size_t v = 0; v < kept; ++v) {
    std::size_t i = home_of(voxels_[v].key);
    while (slots_[i] != kNone) i = (i + 1) & (slots_.size() - 1);
    slots_[i] = static_cast<std::int32_t>(v);
  }
}

}  // namespace convexcut::robust
