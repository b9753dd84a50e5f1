// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/voxel_map.hpp"

#include <algorithm>
#include <bit>

namespace convexcut::robust {
namespace {

constexpr std::size_t kLeastBlocks = 1'024;

}  // namespace

VoxelMap::VoxelMap(std::size_t capacity) {
  const std::size_t blocks = capacity / 4 + kLeastBlocks;
  slots_.resize(std::bit_ceil(2 * blocks));
  is_home_.resize(slots_.size() / kBits);
  places_.reserve((blocks + 1) * kBlock);
  block_voxels_.reserve(blocks + 1);
  voxels_.reserve(capacity);
  clear();
}

void VoxelMap::clear() noexcept {
  voxels_.clear();
  lay_out_anew();
}

void VoxelMap::lay_out_anew() noexcept {
  std::fill(slots_.begin(), slots_.end(), Slot{});
  std::fill(is_home_.begin(), is_home_.end(), std::uint64_t{0});
  places_.assign(kBlock, kNone);
  block_voxels_.assign(1, 0);
  empty_blocks_ = 0;
  for (std::size_t v = 0; v < voxels_.size(); ++v) put(v, find_or_add_block(voxels_[v].key));
}

// The place where it begins; 0 when there is no room for it.
std::size_t VoxelMap::find_or_add_block(VoxelKey key) noexcept {
  const VoxelKey block = block_of(key);
  const std::size_t home = home_of(block);
  std::size_t i = home;
  for (; slots_[i].block != kFree; i = (i + 1) & (slots_.size() - 1)) {
    if (slots_[i].block == block) return slots_[i].first_place;
  }
  if (places_.size() == places_.capacity()) return 0;
  is_home_[home / kBits] |= std::uint64_t{1} << home % kBits;
  slots_[i] = {block, static_cast<std::uint32_t>(places_.size())};
  places_.resize(places_.size() + kBlock, kNone);
  block_voxels_.push_back(0);
  ++empty_blocks_;
  return slots_[i].first_place;
}

void VoxelMap::put(std::size_t voxel, std::size_t block_begin) noexcept {
  const std::size_t place = block_begin + place_in_block(voxels_[voxel].key);
  places_[place] = static_cast<std::int32_t>(voxel);
  voxels_[voxel].place = static_cast<std::uint32_t>(place);
  if (block_voxels_[place / kBlock]++ == 0) --empty_blocks_;
}

std::int32_t VoxelMap::find_or_add(VoxelKey key) noexcept {
  const std::int32_t known = find(key);
  if (known != kNone || voxels_.size() == voxels_.capacity()) return known;
  const std::size_t block_begin = find_or_add_block(key);
  if (block_begin == 0) return kNone;
  voxels_.emplace_back().key = key;
  put(voxels_.size() - 1, block_begin);
  return static_cast<std::int32_t>(voxels_.size() - 1);
}

}  // namespace convexcut::robust
