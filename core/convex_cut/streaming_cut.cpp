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

constexpr std::size_t kMostPoints = std::size_t{1} << 31;

[[nodiscard]] const ConvexCutParameters& checked(const ConvexCutParameters& parameters,
                                                 std::size_t max_points) {
  if (!is_valid(parameters)) throw std::invalid_argument("Convex Cut parameters out of range");
  if (max_points > kMostPoints) throw std::invalid_argument("Convex Cut: too many points");
  return parameters;
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
      keys_(max_points + kKernelPadding),
      counts_(max_points),
      x_(max_points),
      y_(max_points),
      z_(max_points) {
  for (Group& group : groups_) {
    group.points.resize(max_points);
    group.marks.resize(max_points);
  }
}

void StreamingCut::begin() noexcept {
  for (Group& group : groups_) {
    group.count = group.done = 0;
    group.newest = 0;
  }
  status_ = CutStatus::ok;
  size_ = 0;
  ahead_ = behind_ = 0;
  done_ = {};
}

CutStatus StreamingCut::add(const CloudView& cloud) noexcept {
  if (status_ != CutStatus::ok) return status_;
  const std::size_t end = cloud.size();
  const std::size_t count = end - std::min(end, size_);
  const CloudView fresh{cloud.x.subspan(end - count),
                        cloud.y.subspan(std::min(end - count, cloud.y.size())),
                        cloud.z.subspan(std::min(end - count, cloud.z.size()))};
  status_ = end > max_points_ ? CutStatus::too_many_points : check_cloud(fresh, count).status;
  if (status_ != CutStatus::ok) return status_;
  shell_keys(cloud, size_, end, inverse_squared_half_width_, keys_.data());
  take(end);
  const std::uint32_t swept = ahead_ & behind_;
  for (std::uint32_t number = 0; number < groups_.size(); ++number) {
    const Group& group = groups_[number];
    const bool is_swept = (swept >> number & 1U) != 0 && size_ - group.newest > kIdlePoints;
    if (is_swept && group.done != group.count) finish_group(cloud, number);
  }
  return status_;
}

void StreamingCut::take(std::size_t end) noexcept {
  for (; size_ < end; ++size_) {
    const PlaneGroups::Reach& reach = planes_.reach(keys_[size_]);
    ahead_ |= reach.ahead;
    behind_ |= reach.behind;
    counts_[size_] = 0;
    for (std::uint32_t left = reach.any; left != 0; left &= left - 1) {
      Group& group = groups_[static_cast<std::size_t>(std::countr_zero(left))];
      group.points[group.count++] = static_cast<std::uint32_t>(size_);
      group.newest = size_;
    }
  }
}

void StreamingCut::finish_group(const CloudView& cloud, std::uint32_t number) noexcept {
  Group& group = groups_[number];
  // What was found without the newest points need not hold with them.
  for (std::uint32_t i = 0; i < group.done; ++i) {
    counts_[group.points[i]] = static_cast<std::uint8_t>(counts_[group.points[i]] - group.marks[i]);
  }
  for (std::uint32_t i = 0; i < group.count; ++i) {
    const std::uint32_t point = group.points[i];
    x_[i] = cloud.x[point];
    y_[i] = cloud.y[point];
    z_[i] = cloud.z[point];
  }
  const CloudView points{
      {x_.data(), group.count}, {y_.data(), group.count}, {z_.data(), group.count}};
  index_.build(points);
  worker_.begin(index_, check_cloud(points, group.count).extent_m);
  const std::uint32_t end = planes_.end(number);
  for (std::uint32_t plane = planes_.begin(number); plane < end; ++plane) {
    worker_.process(planes_.plane(plane), planes_.windows(plane));
    ++done_.slices;
    done_.again += group.done != 0 ? 1U : 0U;
  }
  const std::span<const std::uint8_t> marks = worker_.marks();
  for (std::size_t i = 0; i < index_.size(); ++i) {
    const std::uint32_t source = index_.source(i);
    group.marks[source] = marks[i];
    std::uint8_t& count = counts_[group.points[source]];
    count = static_cast<std::uint8_t>(count + marks[i]);
  }
  group.done = group.count;
}

CutStatus StreamingCut::finish(const CloudView& cloud, std::span<Label> labels) noexcept {
  if (labels.size() != cloud.size()) return CutStatus::size_mismatch;
  if (add(cloud) != CutStatus::ok) return status_;
  const auto is_left = [](const Group& group) { return group.done != group.count; };
  if (2 * static_cast<std::size_t>(std::ranges::count_if(groups_, is_left)) > groups_.size()) {
    finish_all(cloud, labels);
    return CutStatus::ok;
  }
  for (std::uint32_t number = 0; number < groups_.size(); ++number) {
    if (is_left(groups_[number])) finish_group(cloud, number);
  }
  for (std::size_t i = 0; i < size_; ++i) {
    labels[i] = counts_[i] != 0 ? Label::structure : Label::other;
  }
  return CutStatus::ok;
}

// Where most of the slices are left, all of them at once take less than those left by groups.
void StreamingCut::finish_all(const CloudView& cloud, std::span<Label> labels) noexcept {
  index_.build(cloud);
  worker_.begin(index_, check_cloud(cloud, cloud.size()).extent_m);
  for (std::uint32_t plane = 0; plane < planes_.end(planes_.count() - 1); ++plane) {
    worker_.process(planes_.plane(plane), planes_.windows(plane));
    ++done_.slices;
  }
  const std::span<const std::uint8_t> marks = worker_.marks();
  for (std::size_t i = 0; i < index_.size(); ++i) {
    labels[index_.source(i)] = static_cast<Label>(marks[i]);
  }
}

}  // namespace convexcut
