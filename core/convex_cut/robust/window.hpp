// SPDX-License-Identifier: Apache-2.0
//
// The last revolutions, merged: what a tilted, turning lidar has seen of the room within seconds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/convex_cut/robust/verdict_memory.hpp"
#include "core/convex_cut/robust/voxel_map.hpp"
#include "core/geometry.hpp"
#include "core/workspace.hpp"

namespace convexcut::robust {

class Window {
 public:
  // Allocates for that many voxels, and 48 bytes for each voxel of each revolution, of which there
  // are kUsualVoxels on the average: where there are more, and where a rig goes on so fast that
  // they do not cover each other, fewer revolutions are kept.
  static constexpr std::size_t kUsualVoxels = 14'336;  // in a hall of 60 m
  // Voxels; a room has half as many, and time for all shapes in each revolution.
  static constexpr std::size_t kLargeMap = 20'000;
  Window(std::uint32_t revolutions, std::size_t voxels_per_revolution, std::size_t voxels);

  void clear() noexcept;
  // Adds a revolution that was seen from `origin`, and forgets those beyond the newest `keep`.
  void add(const VoxelMap& revolution, const Vec3f& origin, std::uint32_t keep) noexcept;
  // The same, but the map's voxels stay where they are, also without points, and their shapes as
  // they were. False when there is no room for that: then nothing is done.
  [[nodiscard]] bool add_in_place(const VoxelMap& revolution, const Vec3f& origin,
                                  std::uint32_t keep) noexcept;
  // Instead, for merged() and judge(): a revolution that is not added yet.
  void look_up(const VoxelMap& revolution) noexcept;

  [[nodiscard]] const VoxelMap& map() const noexcept { return map_; }
  [[nodiscard]] std::uint32_t revolutions() const noexcept { return newest_ - oldest_; }
  // Where the lidar was when the voxel was seen last.
  [[nodiscard]] const Vec3f& origin_of(const Voxel& voxel) const noexcept {
    const std::size_t age = newest_ - 1 - voxel.revolution;
    return slots_[newest_slot_ >= age ? newest_slot_ - age : newest_slot_ + slots_.size() - age]
        .origin;
  }
  [[nodiscard]] const Vec3f& origin() const noexcept { return slots_[newest_slot_].origin; }

  // The map's index of a voxel of the revolution that was added or looked up last; VoxelMap::kNone
  // where it had no room, or is not known.
  [[nodiscard]] std::int32_t merged(std::size_t voxel_of_revolution) const noexcept {
    return merged_[voxel_of_revolution];
  }
  // Once a revolution: adds what was decided of such a voxel. That is remembered as long as it is
  // in the window, and by half its weight when it comes back, also before it is added.
  [[nodiscard]] Verdict judge(std::size_t voxel_of_revolution, VoxelKey key,
                              bool is_structure) noexcept {
    const std::int32_t index = merged_[voxel_of_revolution];
    if (index == VoxelMap::kNone) return memory_.find(key).back().add(is_structure);
    return map_.voxels()[static_cast<std::size_t>(index)].verdicts.add(is_structure);
  }

 private:
  struct Entry {
    VoxelKey key;
    Moments moments;
  };
  struct Slot {
    std::size_t first = 0, count = 0;  // of its entries
    Vec3f origin = Vec3f::Zero();
  };
  [[nodiscard]] bool is_full(const VoxelMap& revolution, std::uint32_t keep) const noexcept;
  void forget_oldest() noexcept;
  void remove_empty() noexcept;
  void merge(const VoxelMap& revolution, const Vec3f& origin) noexcept;
  void take_shapes() noexcept;
  [[nodiscard]] Entry& entry(const Slot& slot, std::size_t i) noexcept {
    const std::size_t at = slot.first + i;
    return entries_[at < entries_.size() ? at : at - entries_.size()];
  }

  Workspace<Entry> entries_;  // a ring: those of the revolutions in the map, the oldest first
  std::size_t used_ = 0;
  std::vector<Slot> slots_;
  std::uint32_t oldest_ = 0;  // revolutions [oldest_, newest_) are in the map
  std::uint32_t newest_ = 0;
  std::size_t newest_slot_ = 0;
  VoxelMap map_;
  VerdictMemory memory_;            // of voxels that were in it
  bool has_empty_ = false;          // voxels without points, perhaps
  Workspace<std::int32_t> merged_;  // by voxel of a revolution
  std::uint32_t shapes_taken_ = 0;  // times
};

}  // namespace convexcut::robust
