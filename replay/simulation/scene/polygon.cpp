// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "replay/simulation/scene/shapes.hpp"

namespace convexcut::simulation {
namespace {

// Shapes that share an edge leave no gap: what is this near to an edge belongs to the polygon.
constexpr double kEdgeToleranceM = 1e-9;

// Whether a number may be this near to what is between two others.
bool may_touch(double number, double a, double b) noexcept {
  return number >= std::min(a, b) - 2.0 * kEdgeToleranceM &&
         number <= std::max(a, b) + 2.0 * kEdgeToleranceM;
}

double squared_distance(double u, double v, double from_u, double from_v, double to_u,
                        double to_v) noexcept {
  const double along_u = to_u - from_u;
  const double along_v = to_v - from_v;
  const double length = along_u * along_u + along_v * along_v;
  const double part = ((u - from_u) * along_u + (v - from_v) * along_v) / length;
  const double clamped = std::clamp(part, 0.0, 1.0);
  const double off_u = u - from_u - clamped * along_u;
  const double off_v = v - from_v - clamped * along_v;
  return off_u * off_u + off_v * off_v;
}

}  // namespace

Vec3 loop_normal(const std::vector<Vec3>& loop) noexcept {
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < loop.size(); ++i) {
    normal += (loop[i] - loop[0]).cross(loop[(i + 1) % loop.size()] - loop[0]);
  }
  return normal;
}

Polygon::Polygon(std::vector<std::vector<Vec3>> loops)
    : loops_(std::move(loops)),
      normal_(loop_normal(loops_.front()).normalized()),
      axis_u_(normal_.unitOrthogonal()),
      axis_v_(normal_.cross(axis_u_)),
      offset_(normal_.dot(loops_.front().front())) {
  for (const std::vector<Vec3>& loop : loops_) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec3& from = loop[i];
      const Vec3& to = loop[(i + 1) % loop.size()];
      edges_.push_back({from.dot(axis_u_), from.dot(axis_v_), to.dot(axis_u_), to.dot(axis_v_)});
    }
  }
}

double Polygon::meet(const Ray& ray, double nearest) const noexcept {
  const double approach = normal_.dot(ray.direction);
  if (approach == 0.0) return kNoHit;
  const double distance = (offset_ - normal_.dot(ray.origin)) / approach;
  // Written so that NaN is no hit.
  if (!(distance >= ray.min_distance_m && distance < nearest)) return kNoHit;
  const Vec3 p = ray.origin + distance * ray.direction;
  if (!contains(p.dot(axis_u_), p.dot(axis_v_))) return kNoHit;
  return distance;
}

bool Polygon::contains(double u, double v) const noexcept {
  bool inside = false;
  for (const Edge& edge : edges_) {
    if ((edge.from_v > v) == (edge.to_v > v)) continue;
    double crossed_u = edge.from_u;
    if (edge.to_u != edge.from_u) {
      const double part = (v - edge.from_v) / (edge.to_v - edge.from_v);
      crossed_u += part * (edge.to_u - edge.from_u);
    }
    if (u < crossed_u) inside = !inside;
  }
  if (inside) return true;
  return std::ranges::any_of(edges_, [&](const Edge& e) {
    if (!may_touch(u, e.from_u, e.to_u) || !may_touch(v, e.from_v, e.to_v)) return false;
    return squared_distance(u, v, e.from_u, e.from_v, e.to_u, e.to_v) <=
           kEdgeToleranceM * kEdgeToleranceM;
  });
}

Vec3 Polygon::normal_at(const Vec3& /*p*/) const noexcept { return normal_; }

Bounds Polygon::bounds() const noexcept {
  Bounds bounds;
  for (const std::vector<Vec3>& loop : loops_) {
    for (const Vec3& corner : loop) bounds.add(corner);
  }
  return bounds;
}

Polygon Polygon::placed(const RigidTransform& world_from_local) const {
  std::vector<std::vector<Vec3>> loops = loops_;
  for (std::vector<Vec3>& loop : loops) {
    for (Vec3& corner : loop) corner = world_from_local * corner;
  }
  return Polygon(std::move(loops));
}

}  // namespace convexcut::simulation
