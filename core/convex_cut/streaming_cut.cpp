// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/streaming_cut.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/convex_cut/cloud_check.hpp"
#include "core/convex_cut/cloud_kernels.hpp"

namespace convexcut {
namespace {

// A group that has got none of so many points is taken for swept: those of 4 firings, 1° of a rotor
// at 10 Hz.
constexpr std::size_t kIdlePoints = 128;

// During the revolution, so many late points are worth a look at all slices of a group.
constexpr std::uint32_t kLateAtOnce = 32;

// Slices are kept for late members where one in so many points or more are near the axis.
constexpr std::uint32_t kLeastShareNearAxis = 64;

// A group is rather done again when one in so many of its points are late.
constexpr std::uint32_t kLeastToDoAgain = 4;

// Of a radius in float.
constexpr float kRounding = 1.0F + 1e-5F;

constexpr float kAnywhereM = std::numeric_limits<float>::max();

constexpr std::size_t kMostPoints = std::size_t{1} << 31;

[[nodiscard]] const ConvexCutParameters& checked(const ConvexCutParameters& parameters,
                                                 std::size_t max_points) {
  if (!is_valid(parameters)) throw std::invalid_argument("Convex Cut parameters out of range");
  if (max_points > kMostPoints) throw std::invalid_argument("Convex Cut: too many points");
  return parameters;
}

// visit(number) for each bit.
template <class Visit>
void for_each_group(std::uint32_t groups, Visit&& visit) noexcept {
  for (; groups != 0; groups &= groups - 1) {
    visit(static_cast<std::uint32_t>(std::countr_zero(groups)));
  }
}

}  // namespace

StreamingCut::StreamingCut(const ConvexCutParameters& parameters, std::size_t max_points)
    : inverse_squared_half_width_(static_cast<float>(
          1.0 / (checked(parameters, max_points).half_width_m * parameters.half_width_m))),
      max_points_(max_points),
      planes_(parameters.planes),
      index_(parameters.half_width_m, max_points, 1),
      worker_(parameters, max_points),
      groups_(planes_.count()),
      kept_(parameters),
      keys_(max_points + kKernelPadding),
      counts_(max_points),
      rest_(max_points + 1),  // written before it is known that a point was taken already
      is_taken_(max_points),
      x_(max_points + kKernelPadding),
      y_(max_points + kKernelPadding),
      z_(max_points + kKernelPadding),
      is_undecided_(max_points + kKernelPadding) {
  for (Group& group : groups_) {
    group.points.resize(max_points);
    group.marks.resize(max_points + kKernelPadding);
    group.undecided.reserve(std::min(max_points, KeptSlices::kMostCandidates));
  }
}

void StreamingCut::begin() noexcept {
  for (Group& group : groups_) {
    group.count = group.done = 0;
    group.near_axis = 0;
    group.undecided.clear();
    group.newest = 0;
  }
  status_ = CutStatus::ok;
  size_ = 0;
  extent_m_ = 0.0F;
  ahead_ = behind_ = 0;
  kept_groups_ = stale_groups_ = 0;
  done_ = {};
}

CutStatus StreamingCut::add(const CloudView& cloud) noexcept {
  if (take(cloud) == CutStatus::ok) do_swept(cloud);
  return status_;
}

CutStatus StreamingCut::take(const CloudView& cloud) noexcept {
  if (status_ != CutStatus::ok) return status_;
  const std::size_t end = cloud.size();
  const std::size_t count = end - std::min(end, size_);
  const CloudView fresh{cloud.x.subspan(end - count),
                        cloud.y.subspan(std::min(end - count, cloud.y.size())),
                        cloud.z.subspan(std::min(end - count, cloud.z.size()))};
  const CloudCheck check =
      end > max_points_ ? CloudCheck{CutStatus::too_many_points} : check_cloud(fresh, count);
  status_ = check.status;
  if (status_ != CutStatus::ok) return status_;
  extent_m_ = std::max(extent_m_, check.extent_m);
  shell_keys(cloud, size_, end, inverse_squared_half_width_, keys_.data());
  group_points(end);
  return status_;
}

void StreamingCut::do_swept(const CloudView& cloud) noexcept {
  pruned_ = (pruned_ + 1) % planes_.count();
  groups_[pruned_].undecided.prune(counts_);
  const std::uint32_t swept = ahead_ & behind_;
  for (std::uint32_t number = 0; number < groups_.size(); ++number) {
    const Group& group = groups_[number];
    const bool is_swept = (swept >> number & 1U) != 0 && size_ - group.newest > kIdlePoints;
    if (!is_swept || group.done == group.count) continue;
    const bool is_kept = (kept_groups_ >> number & 1U) != 0;
    if (is_kept && group.count - group.done < kLateAtOnce) continue;
    if (!take_late(cloud, number)) do_group(cloud, number);
  }
}

void StreamingCut::group_points(std::size_t end) noexcept {
  for (; size_ < end; ++size_) {
    const PlaneGroups::Reach& reach = planes_.reach(keys_[size_]);
    if (reach.is_far) {
      ahead_ |= reach.ahead;
      behind_ |= reach.behind;
    }
    counts_[size_] = 0;
    for_each_group(reach.any, [&](std::uint32_t number) {
      Group& group = groups_[number];
      group.points[group.count++] = static_cast<std::uint32_t>(size_);
      group.near_axis += reach.is_far ? 0 : 1;
      if (reach.is_far) group.newest = size_;
    });
  }
}

void StreamingCut::load_points(const CloudView& cloud,
                               std::span<const std::uint32_t> points) noexcept {
  for (std::size_t i = 0; i < points.size(); ++i) {
    x_[i] = cloud.x[points[i]];
    y_[i] = cloud.y[points[i]];
    z_[i] = cloud.z[points[i]];
  }
}

// Points of a group: those near the axis come to the front, as their bounds of u are narrow.
std::array<ShellIndex::Candidates, 2> StreamingCut::load_late(
    const CloudView& cloud, std::span<std::uint32_t> points) noexcept {
  const auto far = std::partition(points.begin(), points.end(), [&](std::uint32_t point) {
    return !planes_.reach(keys_[point]).is_far;
  });
  load_points(cloud, points);
  const auto count = static_cast<std::uint32_t>(points.size());
  const auto near_count = static_cast<std::uint32_t>(far - points.begin());
  float squared_r = 0.0F;
  for (std::uint32_t i = 0; i < near_count; ++i) {
    squared_r = std::max(squared_r, x_[i] * x_[i] + y_[i] * y_[i]);
  }
  const float r_m = std::sqrt(squared_r) * kRounding;
  return {ShellIndex::Candidates{{0, near_count}, -r_m, r_m},
          ShellIndex::Candidates{{near_count, count}, -kAnywhereM, kAnywhereM}};
}

// The points that have come since the group was done. False when it has to be done again.
bool StreamingCut::take_late(const CloudView& cloud, std::uint32_t number) noexcept {
  Group& group = groups_[number];
  const std::uint32_t count = group.count - group.done;
  const bool is_kept = ((kept_groups_ & ~stale_groups_) >> number & 1U) != 0;
  if (!is_kept || count > KeptSlices::kMostCandidates || count * kLeastToDoAgain > group.count) {
    return false;
  }
  const std::span<std::uint32_t> points(group.points.data() + group.done, count);
  const auto ranges = load_late(cloud, points);
  std::uint8_t* const marks = group.marks.data() + group.done;
  std::fill_n(marks, count, std::uint8_t{0});
  std::fill_n(is_undecided_.data(), count, std::uint8_t{0});
  const KeptSlices::Candidates late{{{x_.data(), count}, {y_.data(), count}, {z_.data(), count}},
                                    std::span(ranges).first(ranges[1].range.begin < count ? 2 : 1),
                                    {marks, count}};
  for (std::uint32_t plane = planes_.begin(number); plane < planes_.end(number); ++plane) {
    if (!kept_.add(plane, planes_.plane(plane), late, is_undecided_, extent_m_)) return false;
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint8_t& structure = counts_[points[i]];
    structure = static_cast<std::uint8_t>(structure + marks[i]);
    if (structure == 0 && is_undecided_[i] != 0) leave_undecided(cloud, number, points[i]);
  }
  group.done = group.count;
  return true;
}

void StreamingCut::leave_undecided(const CloudView& cloud, std::uint32_t number,
                                   std::uint32_t point) noexcept {
  if (!groups_[number].undecided.add(cloud, point)) stale_groups_ |= 1U << number;
}

// What was found without the newest points need not hold with them. What other groups left to this
// one, they have to decide now.
void StreamingCut::take_back(const CloudView& cloud, std::uint32_t number) noexcept {
  kept_groups_ &= ~(1U << number);
  stale_groups_ &= ~(1U << number);
  Group& group = groups_[number];
  group.undecided.clear();
  for (std::uint32_t i = 0; i < group.done; ++i) {
    const std::uint32_t point = group.points[i];
    std::uint8_t& structure = counts_[point];
    structure = static_cast<std::uint8_t>(structure - group.marks[i]);
    if (group.marks[i] != 0 && structure == 0) reopen(cloud, point);
  }
}

void StreamingCut::reopen(const CloudView& cloud, std::uint32_t point) noexcept {
  for_each_group(planes_.reach(keys_[point]).any & kept_groups_,
                 [&](std::uint32_t number) { leave_undecided(cloud, number, point); });
}

void StreamingCut::do_group(const CloudView& cloud, std::uint32_t number) noexcept {
  Group& group = groups_[number];
  take_back(cloud, number);
  load_points(cloud, {group.points.data(), group.count});
  index_.build({{x_.data(), group.count}, {y_.data(), group.count}, {z_.data(), group.count}});
  worker_.begin(index_, extent_m_);
  const bool is_kept =
      group.near_axis * kLeastShareNearAxis > group.count && kept_.margin_m() > 0.0;
  if (is_kept) std::fill_n(is_undecided_.data(), group.count, std::uint8_t{0});
  do_slices(number, is_kept);
  const std::span<const std::uint8_t> marks = worker_.marks();
  for (std::size_t i = 0; i < index_.size(); ++i) {
    const std::uint32_t source = index_.source(i);
    group.marks[source] = marks[i];
    std::uint8_t& structure = counts_[group.points[source]];
    structure = static_cast<std::uint8_t>(structure + marks[i]);
  }
  group.done = group.count;
  if (is_kept) list_undecided(cloud, number);
}

void StreamingCut::do_slices(std::uint32_t number, bool keep) noexcept {
  const std::uint32_t begin = planes_.begin(number);
  const std::uint32_t end = planes_.end(number);
  done_.slices += end - begin;
  done_.again += groups_[number].done != 0 ? end - begin : 0;
  for (std::uint32_t plane = begin; plane < end; ++plane) {
    if (keep) {
      worker_.process_to(static_cast<float>(kept_.margin_m()), planes_.plane(plane),
                         planes_.windows(plane));
      if (kept_.keep(plane, worker_.hull(), worker_.tolerance_m())) {
        for (const std::uint32_t position : worker_.undecided()) is_undecided_[position] = 1;
        continue;
      }
    }
    worker_.process(planes_.plane(plane), planes_.windows(plane));
  }
}

void StreamingCut::list_undecided(const CloudView& cloud, std::uint32_t number) noexcept {
  const Group& group = groups_[number];
  kept_groups_ |= 1U << number;
  for (std::size_t i = 0; i < index_.size(); ++i) {
    if (is_undecided_[i] == 0) continue;
    const std::uint32_t point = group.points[index_.source(i)];
    if (counts_[point] == 0) leave_undecided(cloud, number, point);
  }
}

CutStatus StreamingCut::finish(const CloudView& cloud, std::span<Label> labels) noexcept {
  if (labels.size() != cloud.size()) return CutStatus::size_mismatch;
  if (take(cloud) != CutStatus::ok) return status_;
  const std::uint32_t all = (1U << groups_.size()) - 1;
  std::uint32_t next = 0;  // to be done again
  for_each_group(all, [&](std::uint32_t number) {
    const Group& group = groups_[number];
    if (group.done != group.count && !take_late(cloud, number)) next |= 1U << number;
  });
  std::uint32_t left = 0;
  for (next |= stale_groups_; next != 0; next = stale_groups_) {
    left |= next;
    kept_groups_ &= ~left;
    for_each_group(next, [&](std::uint32_t number) { take_back(cloud, number); });
  }
  if (left != 0) do_rest(cloud, left);
  for_each_group(kept_groups_, [&](std::uint32_t number) { decide(number); });
  for (std::size_t i = 0; i < size_; ++i) {
    labels[i] = counts_[i] != 0 ? Label::structure : Label::other;
  }
  return CutStatus::ok;
}

// The slices of the groups that are left, at once: the points of these groups are sorted together,
// and those that are structure already need no decision.
void StreamingCut::do_rest(const CloudView& cloud, std::uint32_t left) noexcept {
  std::fill_n(is_taken_.data(), size_, std::uint8_t{0});
  std::size_t count = 0;
  for_each_group(left, [&](std::uint32_t number) {
    const Group& group = groups_[number];
    for (const std::uint32_t point : std::span(group.points).first(group.count)) {
      rest_[count] = point;
      count += 1U - is_taken_[point];
      is_taken_[point] = 1;
    }
  });
  load_points(cloud, {rest_.data(), count});
  index_.build({{x_.data(), count}, {y_.data(), count}, {z_.data(), count}});
  worker_.begin(index_, extent_m_);
  const std::span<std::uint8_t> marks = worker_.marks();
  for (std::size_t i = 0; i < count; ++i) marks[i] = counts_[rest_[index_.source(i)]] != 0 ? 1 : 0;
  for_each_group(left, [&](std::uint32_t number) { do_slices(number, false); });
  for (std::size_t i = 0; i < count; ++i) counts_[rest_[index_.source(i)]] = marks[i];
}

void StreamingCut::decide(std::uint32_t number) noexcept {
  UndecidedPoints& undecided = groups_[number].undecided;
  undecided.prune(counts_);
  const auto count = static_cast<std::uint32_t>(undecided.points().size());
  if (count == 0) return;
  const std::span<std::uint8_t> marks = std::span(is_undecided_).first(count);
  std::ranges::fill(marks, std::uint8_t{0});
  const ShellIndex::Candidates anywhere{{0, count}, -kAnywhereM, kAnywhereM};
  for (std::uint32_t plane = planes_.begin(number); plane < planes_.end(number); ++plane) {
    kept_.decide(plane, planes_.plane(plane), {undecided.columns(), {&anywhere, 1}, marks},
                 extent_m_);
  }
  for (std::uint32_t i = 0; i < count; ++i) counts_[undecided.points()[i]] = marks[i];
}

}  // namespace convexcut
