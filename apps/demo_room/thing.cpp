// SPDX-License-Identifier: Apache-2.0
#include "apps/demo_room/thing.hpp"

#include <algorithm>
#include <utility>

namespace convexcut::sim {

Thing::Thing(std::vector<Box> boxes, std::vector<Cylinder> cylinders)
    : boxes_(std::move(boxes)), cylinders_(std::move(cylinders)), centre_(Vec3::Zero()) {
  for (const Box& box : boxes_) centre_ += box.middle();
  for (const Cylinder& cylinder : cylinders_) centre_ += cylinder.middle();
  centre_ /= static_cast<double>(std::max<std::size_t>(boxes_.size() + cylinders_.size(), 1));
  const auto enclose = [this](const auto& solid) {
    radius_ = std::max(radius_, (solid.middle() - centre_).norm() + solid.reach());
  };
  std::ranges::for_each(boxes_, enclose);
  std::ranges::for_each(cylinders_, enclose);
}

void Thing::meet(const Ray& ray, Hit& nearest) const noexcept {
  const Vec3 to_centre = centre_ - ray.origin;
  const double along = to_centre.dot(ray.direction);
  if (along < -radius_ || along - radius_ > nearest.range_m) return;
  if (to_centre.squaredNorm() - along * along > radius_ * radius_) return;
  for (const Box& box : boxes_) box.meet(ray, nearest);
  for (const Cylinder& cylinder : cylinders_) cylinder.meet(ray, nearest);
}

void Thing::shift(const Vec3& by) noexcept {
  centre_ += by;
  for (Box& box : boxes_) box.shift(by);
  for (Cylinder& cylinder : cylinders_) cylinder.shift(by);
}

}  // namespace convexcut::sim
