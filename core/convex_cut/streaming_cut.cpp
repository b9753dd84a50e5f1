// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/streaming_cut.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "core/convex_cut/cloud_check.hpp"
#include "core/convex_cut/cloud_kernels.hpp"

namespace convexcut {
namespace {

// A group that has got none of so many points is taken for swept: those of 16 firings, 3° of a
// rotor at 10 Hz.
constexpr std::size_t kIdlePoints = 512;

// During the revolution, so many late points are worth a look at all slices of a group.
constexpr std::uint32_t kLateAtOnce = 512;

// Slices are kept for late members where one in so many points or more are near the axis.
constexpr std::uint32_t kLeastShareNearAxis = 16;

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
      z_(max_points + kKernelPadding) {
  for (Group& group : groups_) {
    group.points.resize(max_points);
    group.marks.resize(max_points + kKernelPadding);
  }
}

void StreamingCut::begin() noexcept {
  for (Group& group : groups_) {
    group.count = group.done = 0;
    group.near_axis = 0;
    group.is_kept = false;
    group.newest = 0;
  }
  status_ = CutStatus::ok;
  size_ = 0;
  extent_m_ = 0.0F;
  ahead_ = behind_ = 0;
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
  const std::uint32_t swept = ahead_ & behind_;
  for (std::uint32_t number = 0; number < groups_.size(); ++number) {
    const Group& group = groups_[number];
    const bool is_swept = (swept >> number & 1U) != 0 && size_ - group.newest > kIdlePoints;
    if (!is_swept || group.done == group.count) continue;
    if (group.is_kept && group.count - group.done < kLateAtOnce) continue;
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

// The points that have come since the group was done. False when it has to be done again.
bool StreamingCut::take_late(const CloudView& cloud, std::uint32_t number) noexcept {
  Group& group = groups_[number];
  const std::uint32_t count = group.count - group.done;
  if (!group.is_kept || count > KeptSlices::kMostLate) return false;
  load_points(cloud, {group.points.data() + group.done, count});
  std::uint8_t* const marks = group.marks.data() + group.done;
  std::fill_n(marks, count, std::uint8_t{0});
  const KeptSlices::Late late{{group.points.data() + group.done, count},
                              {{x_.data(), count}, {y_.data(), count}, {z_.data(), count}},
                              {marks, count}};
  for (std::uint32_t plane = planes_.begin(number); plane < planes_.end(number); ++plane) {
    if (!kept_.add(plane, planes_.plane(plane), late, extent_m_)) return false;
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint8_t& structure = counts_[late.points[i]];
    structure = static_cast<std::uint8_t>(structure + marks[i]);
  }
  group.done = group.count;
  return true;
}

// What was found without the newest points need not hold with them.
void StreamingCut::take_back(std::uint32_t number) noexcept {
  const Group& group = groups_[number];
  for (std::uint32_t i = 0; i < group.done; ++i) {
    std::uint8_t& structure = counts_[group.points[i]];
    structure = static_cast<std::uint8_t>(structure - group.marks[i]);
  }
}

void StreamingCut::do_group(const CloudView& cloud, std::uint32_t number) noexcept {
  Group& group = groups_[number];
  take_back(number);
  load_points(cloud, {group.points.data(), group.count});
  index_.build({{x_.data(), group.count}, {y_.data(), group.count}, {z_.data(), group.count}});
  worker_.begin(index_, extent_m_);
  group.is_kept = group.near_axis * kLeastShareNearAxis > group.count && kept_.margin_m() > 0.0;
  do_slices(number, group.is_kept);
  const std::span<const std::uint8_t> marks = worker_.marks();
  for (std::size_t i = 0; i < index_.size(); ++i) {
    const std::uint32_t source = index_.source(i);
    group.marks[source] = marks[i];
    std::uint8_t& structure = counts_[group.points[source]];
    structure = static_cast<std::uint8_t>(structure + marks[i]);
  }
  group.done = group.count;
  if (group.is_kept) number_undecided(number);
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
      if (kept_.keep(plane, worker_.hull(), worker_.undecided(), worker_.tolerance_m())) continue;
    }
    worker_.process(planes_.plane(plane), planes_.windows(plane));
  }
}

void StreamingCut::number_undecided(std::uint32_t number) noexcept {
  const Group& group = groups_[number];
  const std::span<const std::uint8_t> marks = worker_.marks();
  for (std::uint32_t plane = planes_.begin(number); plane < planes_.end(number); ++plane) {
    kept_.renumber(plane, [&](std::uint32_t position) {
      return marks[position] != 0 ? kNobody : group.points[index_.source(position)];
    });
  }
}

CutStatus StreamingCut::finish(const CloudView& cloud, std::span<Label> labels) noexcept {
  if (labels.size() != cloud.size()) return CutStatus::size_mismatch;
  if (take(cloud) != CutStatus::ok) return status_;
  const std::uint32_t all = (1U << groups_.size()) - 1;
  std::uint32_t left = 0;
  for_each_group(all, [&](std::uint32_t number) {
    const Group& group = groups_[number];
    if (group.done != group.count && !take_late(cloud, number)) left |= 1U << number;
  });
  for_each_group(left, [&](std::uint32_t number) { take_back(number); });
  if (left != 0) do_rest(cloud, left);
  for_each_group(all & ~left, [&](std::uint32_t number) { decide(cloud, number); });
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

void StreamingCut::decide(const CloudView& cloud, std::uint32_t number) noexcept {
  if (!groups_[number].is_kept) return;
  for (std::uint32_t plane = planes_.begin(number); plane < planes_.end(number); ++plane) {
    kept_.decide(plane, planes_.plane(plane), cloud, extent_m_, counts_);
  }
}

}  // namespace convexcut
