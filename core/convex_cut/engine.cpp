// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/engine.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <stdexcept>

#include "core/convex_cut/cloud_check.hpp"

namespace convexcut {
namespace {

// Planes that a thread takes at once. Neighbouring planes share most of their points, which are
// marked then and still in the thread's cache; more at once would leave the team idle at the end.
constexpr std::uint32_t kPlanesAtOnce = 10;

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
      index_(parameters.half_width_m, checked(max_points), threads),
      max_points_(max_points),
      magnitudes_(index_.parts()),
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
  if (!sizes_match(cloud, labels.size())) return CutStatus::size_mismatch;

  index_.begin(cloud);
  prepare_steps(plane_stride);
  for (const std::unique_ptr<SliceWorker>& worker : workers_) worker->forget();
  auto work = [&](unsigned member) noexcept {
    SliceWorker& worker = *workers_[member];
    steps_.count.run(member, [&](std::uint32_t part) { magnitudes_[part] = index_.count(part); });
    if (extent_m() > kMaxCoordinateM) return;
    steps_.lay_out.run(member, [&](std::uint32_t) {
      index_.lay_out();
      prepare_step(steps_.number, index_.runs());
      prepare_step(steps_.spread, index_.pieces());
      prepare_step(steps_.write, index_.pieces());
    });
    steps_.number.run(member, [&](std::uint32_t run) { index_.number_keys(run); });
    steps_.place.run(member, [&](std::uint32_t part) { index_.place(part); });
    steps_.spread.run(member, [&](std::uint32_t piece) { index_.spread(piece); });
    steps_.slices.run(member,
                      [&](std::uint32_t group) { process_slices(worker, group, plane_stride); });
    steps_.write.run(member, [&](std::uint32_t piece) { write_labels(piece, labels); });
  };
  team_.run(work);
  return extent_m() > kMaxCoordinateM ? CutStatus::coordinate_out_of_range : CutStatus::ok;
}

void ConvexCutEngine::prepare_steps(std::uint32_t plane_stride) noexcept {
  const ShellIndex::Shares parts{index_.parts(), (index_.parts() + 1) / 2};
  prepare_step(steps_.count, parts);
  steps_.lay_out.prepare(1);
  prepare_step(steps_.place, parts);
  steps_.slices.prepare((cut_planes(plane_stride) + kPlanesAtOnce - 1) / kPlanesAtOnce);
}

void ConvexCutEngine::prepare_step(SharedStep& step, const ShellIndex::Shares& shares) noexcept {
  const auto items = static_cast<std::uint32_t>(shares.count);
  if (team_.size() == 1) {
    step.prepare(items);
  } else {
    step.prepare(items, static_cast<std::uint32_t>(shares.in_front));
  }
}

std::uint32_t ConvexCutEngine::cut_planes(std::uint32_t plane_stride) const noexcept {
  return (static_cast<std::uint32_t>(planes_.size()) + plane_stride - 1) / plane_stride;
}

// The greatest magnitude of a coordinate. Infinity and the NaNs are greater than any number.
float ConvexCutEngine::extent_m() const noexcept {
  constexpr auto kInfinity = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity());
  return std::bit_cast<float>(std::min(std::ranges::max(magnitudes_), kInfinity));
}

void ConvexCutEngine::process_slices(SliceWorker& worker, std::uint32_t group,
                                     std::uint32_t plane_stride) noexcept {
  if (!worker.has_begun()) worker.begin(index_, extent_m());
  const std::size_t planes = cut_planes(plane_stride);
  constexpr std::size_t kHalfTurnBuckets = ShellIndex::kBuckets / 2;
  const std::size_t front = planes * (index_.front_bucket() % kHalfTurnBuckets) / kHalfTurnBuckets;
  const std::size_t first = std::size_t{group} * kPlanesAtOnce;
  for (std::size_t k = first; k < std::min(first + kPlanesAtOnce, planes); ++k) {
    const std::size_t i = (front + k) % planes * plane_stride;
    worker.process(planes_[i], windows_[i]);
  }
}

// A point is structure when any thread that has come in time for a slice has marked it.
void ConvexCutEngine::write_labels(std::uint32_t piece, std::span<Label> labels) noexcept {
  const auto [begin, end] = index_.piece(piece);
  std::array<std::uint8_t, ShellIndex::kChunk> marks{};
  for (const std::unique_ptr<SliceWorker>& worker : workers_) {
    if (!worker->has_begun()) continue;
    const std::uint8_t* const of_worker = worker->marks().data() + begin;
    for (std::size_t i = 0; i < end - begin; ++i) {
      marks[i] = static_cast<std::uint8_t>(marks[i] | of_worker[i]);
    }
  }
  for (std::size_t i = begin; i < end; ++i) {
    labels[index_.source(i)] = static_cast<Label>(marks[i - begin]);
  }
}

}  // namespace convexcut
