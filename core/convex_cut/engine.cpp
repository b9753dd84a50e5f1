// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/engine.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/convex_cut/cloud_check.hpp"

namespace convexcut {
namespace {

// Planes that a thread takes at once. Neighbouring planes share most of their points, which are
// marked then and still in the thread's cache; more at once would leave the team idle at the end.
constexpr std::uint32_t kPlanesAtOnce = 30;

constexpr std::size_t kMostPoints = std::size_t{1} << 31;

[[nodiscard]] const ConvexCutParameters& checked(const ConvexCutParameters& parameters) {
  if (!is_valid(parameters)) throw std::invalid_argument("Convex Cut parameters out of range");
  return parameters;
}

[[nodiscard]] std::size_t checked(std::size_t max_points) {
  if (max_points > kMostPoints) throw std::invalid_argument("Convex Cut: too many points");
  return max_points;
}

}  // namespace

ConvexCutEngine::ConvexCutEngine(const ConvexCutParameters& parameters, std::size_t max_points,
                                 unsigned threads)
    : parameters_(checked(parameters)),
      index_(parameters.half_width_m, checked(max_points)),
      max_points_(max_points),
      team_(threads) {
  planes_.reserve(parameters.planes);
  windows_.reserve(parameters.planes);
  for (std::uint32_t i = 0; i < parameters.planes; ++i) {
    planes_.push_back(slicing_plane(i, parameters.planes));
    windows_.push_back(ShellIndex::windows(planes_.back()));
  }
  for (unsigned member = 0; member < team_.size(); ++member) {
    workers_.push_back(std::make_unique<SliceWorker>(parameters, max_points));
  }
}

CutStatus ConvexCutEngine::label(const CloudView& cloud, std::span<Label> labels,
                                 std::uint32_t plane_stride) noexcept {
  if (cloud.size() > max_points()) return CutStatus::too_many_points;
  const CloudCheck check = check_cloud(cloud, labels.size());
  if (check.status != CutStatus::ok) return check.status;

  index_.build(cloud);
  next_plane_.store(0, std::memory_order_relaxed);  // published by the team
  auto work = [&](unsigned member) noexcept {
    workers_[member]->begin(index_, check.extent_m);
    process_slices(*workers_[member], plane_stride);
  };
  team_.run(work);

  const std::span<const std::uint32_t> source = index_.source();
  const std::span<std::uint8_t> marks = workers_.front()->marks();
  for (std::size_t member = 1; member < workers_.size(); ++member) {
    const std::span<const std::uint8_t> others = workers_[member]->marks();
    for (std::size_t i = 0; i < source.size(); ++i) {
      marks[i] = static_cast<std::uint8_t>(marks[i] | others[i]);
    }
  }
  for (std::size_t i = 0; i < source.size(); ++i) {
    labels[source[i]] = static_cast<Label>(marks[i]);
  }
  return CutStatus::ok;
}

void ConvexCutEngine::process_slices(SliceWorker& worker, std::uint32_t plane_stride) noexcept {
  const auto end = (static_cast<std::uint32_t>(planes_.size()) + plane_stride - 1) / plane_stride;
  // Relaxed: the counter only deals the planes out. Which thread takes one does not matter: the
  // labels are a union.
  for (std::uint32_t begin = next_plane_.fetch_add(kPlanesAtOnce, std::memory_order_relaxed);
       begin < end; begin = next_plane_.fetch_add(kPlanesAtOnce, std::memory_order_relaxed)) {
    for (std::uint32_t i = begin; i < std::min(begin + kPlanesAtOnce, end); ++i) {
      const std::size_t plane = std::size_t{i} * plane_stride;
      worker.process(planes_[plane], windows_[plane]);
    }
  }
}

}  // namespace convexcut
