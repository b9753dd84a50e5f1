// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/window.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "core/convex_cut/robust/shape.hpp"

namespace convexcut::robust {
namespace {

constexpr std::uint32_t kTurns = 4;
constexpr std::int32_t kHardlyChanged = 3;  // a third of the points; in a full window, four turns'

// Where most of a voxel's points are as they were, its shape hardly changes from one revolution to
// the next: such voxels take turns, by their place, so that no revolution has all of them.
[[nodiscard]] bool is_due(const Voxel& voxel, std::uint32_t turn) noexcept {
  const VoxelKey place = voxel.key + (voxel.key >> 21U) + (voxel.key >> 42U);
  return kHardlyChanged * voxel.changed > voxel.moments.count || (place + turn) % kTurns == 0;
}

}  // namespace

Window::Window(std::uint32_t revolutions, std::size_t voxels_per_revolution, std::size_t voxels)
    : slots_(revolutions), map_(voxels), memory_(voxels) {
  entries_.resize(std::max({std::size_t{1}, voxels_per_revolution,
                            revolutions * std::min(voxels_per_revolution, kUsualVoxels)}));
  merged_.resize(voxels_per_revolution);
}

void Window::clear() noexcept {
  map_.clear();
  memory_.clear();
  oldest_ = newest_ = 0;
  used_ = 0;
  shapes_taken_ = 0;
  has_empty_ = false;
}

void Window::add(const VoxelMap& revolution, const Vec3f& origin, std::uint32_t keep) noexcept {
  if (has_empty_) remove_empty();
  while (newest_ != oldest_ && is_full(revolution, keep)) {
    forget_oldest();
    remove_empty();
  }
  merge(revolution, origin);
  take_shapes();
}

bool Window::add_in_place(const VoxelMap& revolution, const Vec3f& origin,
                          std::uint32_t keep) noexcept {
  if (map_.size() + revolution.size() > map_.capacity()) return false;
  while (newest_ != oldest_ && is_full(revolution, keep)) forget_oldest();
  merge(revolution, origin);
  return true;
}

void Window::look_up(const VoxelMap& revolution) noexcept {
  for (std::size_t i = 0; i < revolution.size(); ++i) {
    merged_[i] = map_.find(revolution.voxels()[i].key);
  }
}

bool Window::is_full(const VoxelMap& revolution, std::uint32_t keep) const noexcept {
  keep = std::clamp<std::uint32_t>(keep, 1U, static_cast<std::uint32_t>(slots_.size()));
  return newest_ - oldest_ >= keep || used_ + revolution.size() > entries_.size() ||
         map_.size() + revolution.size() > map_.capacity();
}

void Window::merge(const VoxelMap& revolution, const Vec3f& origin) noexcept {
  const Slot& last = slots_[(newest_ + slots_.size() - 1) % slots_.size()];
  const std::size_t first = (last.first + last.count) % entries_.size();
  newest_slot_ = newest_ % slots_.size();
  Slot& slot = slots_[newest_slot_];
  slot = {first, 0, origin};
  for (std::size_t i = 0; i < revolution.size(); ++i) {
    const Voxel& voxel = revolution.voxels()[i];
    const std::int32_t index = map_.find_or_add(voxel.key);
    merged_[i] = index;
    if (index == VoxelMap::kNone) continue;
    Voxel& merged = map_.voxels()[static_cast<std::size_t>(index)];
    if (merged.verdicts.is_empty()) merged.verdicts = memory_.find(voxel.key).back();
    merged.change(voxel.moments, +1);
    merged.revolution = newest_;
    entry(slot, slot.count++) = {voxel.key, voxel.moments};
  }
  used_ += slot.count;
  ++newest_;
}

void Window::forget_oldest() noexcept {
  const Slot& slot = slots_[oldest_++ % slots_.size()];
  for (std::size_t i = 0; i < slot.count; ++i) {
    const auto& [key, moments] = entry(slot, i);
    const std::int32_t index = map_.find(key);
    if (index == VoxelMap::kNone) continue;
    map_.voxels()[static_cast<std::size_t>(index)].change(moments, -1);
  }
  used_ -= slot.count;
  has_empty_ = true;
}

void Window::remove_empty() noexcept {
  map_.remove_empty([&](const Voxel& voxel) {
    if (voxel.verdicts.are_settled()) memory_.put(voxel.key, voxel.verdicts);
  });
  has_empty_ = false;
}

void Window::take_shapes() noexcept {
  std::array<std::uint32_t, kShapesAtOnce> changed;
  std::size_t count = 0;
  const bool take_turns = map_.size() > kLargeMap;
  ++shapes_taken_;
  for (std::size_t i = 0; i < map_.size(); ++i) {
    Voxel& voxel = map_.voxels()[i];
    if (voxel.changed == 0) continue;
    if (voxel.moments.count < kSupport) {
      voxel.shape = Shape::other;
      continue;
    }
    if (take_turns && !is_due(voxel, shapes_taken_)) continue;
    voxel.changed = 0;
    changed[count++] = static_cast<std::uint32_t>(i);
    if (count < kShapesAtOnce) continue;
    robust::take_shapes(map_, changed);
    count = 0;
  }
  robust::take_shapes(map_, std::span(changed).first(count));
}

}  // namespace convexcut::robust
