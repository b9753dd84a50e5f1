// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/robust/furniture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace convexcut::robust {
namespace {

constexpr float kParallel = 0.98F;  // cosine
constexpr float kDeepestM = 1.0F;   // furniture before its wall
constexpr float kFixtureM = 0.12F;  // boards, shades, radiators
constexpr float kFlushM = 0.045F;   // nearer is the wall itself
constexpr float kReachM = 2.0F;     // a wall counts as far as this beside what was seen of it
constexpr float kGoesOnM = 0.2F;    // beside or above the front
constexpr float kNeighbourM = 1.0F;
constexpr float kSameHeightM = 0.1F;
constexpr float kDeepestRecessM = 0.35F;  // of a window
constexpr float kSillM = 0.3F;
constexpr float kToCeilingM = 0.45F;
constexpr float kLeastHeightM = 1.1F;      // of a narrow face: five cells
constexpr float kLeastFlatHeightM = 0.9F;  // of a flat one: four
constexpr float kFewSteps = 0.15F;
constexpr float kTouchM = 0.5F;
constexpr float kWidestSideM = 2.5F;
constexpr float kSameTopM = 0.6F;
constexpr float kRounder = 1.7F;   // spread², relative to the noise²
constexpr float kHangingM = 1.6F;  // over the floor
constexpr float kLeastBeamM = 1.6F;
constexpr float kTallestLampM = 1.1F;  // four cells
constexpr int kPasses = 2;             // fronts before fronts

// Whether depths change from cell to cell, as they do in clothes. spread: the spread² about the
// plane, relative to the noise²; steps: as WallSegment has them.
[[nodiscard]] constexpr bool is_uneven(float spread, float steps) noexcept {
  return spread > 1.3F && steps > 0.3F;
}

struct PlaneExtent {
  float begin_m = 1e9F, end_m = -1e9F;
  void add(const WallSegment& s) noexcept {
    begin_m = std::min(begin_m, s.begin_m);
    end_m = std::max(end_m, s.end_m);
  }
};

[[nodiscard]] bool is_tall(const Model& model, const WallSegment& s) noexcept {
  const bool floor_known = !std::isinf(model.floor_z);
  return s.top_m > model.ceiling_z - kToCeilingM ||
         (floor_known && s.top_m > model.floor_z + kTallerThanFurnitureM);
}

// Of all its segments, or of those accepted.
[[nodiscard]] PlaneExtent extent_of(const Model& model, std::size_t plane,
                                    bool accepted_only) noexcept {
  PlaneExtent extent;
  for (const WallSegment& s : model.segments) {
    if (s.plane == plane && (s.accepted || !accepted_only)) extent.add(s);
  }
  return extent;
}

// The highest part of a plane's accepted segments near a stretch along it.
[[nodiscard]] float top_near(const Model& model, std::size_t plane, const WallSegment& s,
                             float reach_m) noexcept {
  float top = -1e9F;
  for (const WallSegment& other : model.segments) {
    if (other.plane != plane || !other.accepted) continue;
    if (other.begin_m < s.end_m + reach_m && other.end_m > s.begin_m - reach_m) {
      top = std::max(top, other.top_m);
    }
  }
  return top;
}

// A pane in a recess of the front: it begins well above the front's bottom and does not rise above
// its top.
[[nodiscard]] bool is_pane_of(const Model& model, std::size_t front, std::size_t wall) noexcept {
  float bottom = 1e9F;
  float top = -1e9F;
  float front_bottom = 1e9F;
  float front_top = -1e9F;
  for (const WallSegment& s : model.segments) {
    if (s.plane == wall && s.accepted) {
      bottom = std::min(bottom, s.bottom_m);
      top = std::max(top, s.top_m);
    }
    if (s.plane == front) {
      front_bottom = std::min(front_bottom, s.bottom_m);
      front_top = std::max(front_top, s.top_m);
    }
  }
  return bottom > front_bottom + kSillM && top < front_top + kSillM;
}

[[nodiscard]] bool stands_before(const Model& model, const WallSegment& front, std::size_t wall,
                                 bool tall) noexcept {
  const Plane& plane = model.planes[front.plane];
  const Plane& behind = model.planes[wall];
  if (!behind.vertical || behind.normal.dot(plane.normal) < kParallel) return false;
  const float depth = behind.height_of(point_of(plane, front.middle_m()));
  if (depth < kFlushM || depth > kDeepestM) return false;
  const bool fixture = depth < kFixtureM;
  if (fixture && behind.surfels < plane.surfels) return false;
  // A tall front is furniture only before a wall that was seen as high.
  const bool higher = front.top_m < model.ceiling_z - kToCeilingM &&
                      top_near(model, wall, front, kReachM) > front.top_m - kSameHeightM;
  if (!fixture && tall && !higher) return false;
  if (depth < kDeepestRecessM && is_pane_of(model, front.plane, wall)) return false;
  const PlaneExtent of_wall = extent_of(model, wall, true);
  if (of_wall.begin_m > front.end_m + kReachM || of_wall.end_m < front.begin_m - kReachM) {
    return false;
  }
  const PlaneExtent of_front = extent_of(model, front.plane, false);
  const bool beyond =
      of_wall.begin_m < of_front.begin_m - kGoesOnM || of_wall.end_m > of_front.end_m + kGoesOnM;
  const bool above = top_near(model, wall, front, kNeighbourM) > front.top_m + kGoesOnM;
  const bool wide = front.width_m() > kNarrowM;
  return (beyond || above) && (wide || fixture);
}

// Whether another face of about the same height meets this one's end at an edge.
[[nodiscard]] bool meets_at(const Model& model, const WallSegment& face, float end_m,
                            const WallSegment& other) noexcept {
  const Plane& plane = model.planes[face.plane];
  const Plane& across = model.planes[other.plane];
  if (std::abs(across.normal.dot(plane.normal)) > 0.5F) return false;
  if (std::abs(other.top_m - face.top_m) > kSameTopM) return false;
  const Vec3f end = point_of(plane, end_m);
  return (point_of(across, other.begin_m) - end).head<2>().norm() < kTouchM ||
         (point_of(across, other.end_m) - end).head<2>().norm() < kTouchM;
}

[[nodiscard]] bool meets(const Model& model, const WallSegment& face,
                         const WallSegment& other) noexcept {
  return meets_at(model, face, face.begin_m, other) || meets_at(model, face, face.end_m, other);
}

// A side of furniture (a stand's, a cubicle's) meets it at one end, and no wall at the other one,
// that rays pass beside.
[[nodiscard]] bool is_side(const Model& model, const WallSegment& s) noexcept {
  if (s.top_m > model.ceiling_z - kToCeilingM || s.width_m() > kWidestSideM) return false;
  const auto any_at = [&](float end_m, const auto& test) {
    return std::any_of(model.segments.begin(), model.segments.end(), [&](const WallSegment& other) {
      return test(other) && meets_at(model, s, end_m, other);
    });
  };
  const auto is_furniture = [](const WallSegment& other) { return other.furniture; };
  const auto is_wall = [](const WallSegment& other) { return other.accepted; };
  const auto is = [&](float from_m, float free_m) {
    return any_at(from_m, is_furniture) && !any_at(free_m, is_wall);
  };
  return (s.free_end && is(s.begin_m, s.end_m)) || (s.free_begin && is(s.end_m, s.begin_m));
}

// Whether its plane has another part, a wide one, that is a wall.
[[nodiscard]] bool is_on_wider(const Model& model, const WallSegment& face) noexcept {
  return std::any_of(model.segments.begin(), model.segments.end(), [&](const WallSegment& s) {
    return &s != &face && s.plane == face.plane && s.accepted && !s.narrow &&
           s.width_m() > kNarrowM;
  });
}

// As the faces of pillars are, and nothing passes it.
[[nodiscard]] bool is_flat(const Model& model, const WallSegment& face) noexcept {
  return face.open == 0 && face.spread2 <= kFlatFace * model.noise2 && face.steps <= kFewSteps;
}

// Of a narrow face, by itself.
[[nodiscard]] bool is_round(const Model& model, const WallSegment& s) noexcept {
  const float spread = s.spread2 / model.noise2;
  return spread > kRounder || is_uneven(spread, s.steps);
}

[[nodiscard]] bool is_too_short(const Model& model, const WallSegment& s) noexcept {
  const float least_m = is_flat(model, s) ? kLeastFlatHeightM : kLeastHeightM;
  return s.top_m < model.floor_z + kLowM || s.top_m - s.bottom_m < least_m;
}

// A person shows no flat face, but a pillar's may be seen as a round one: where it lies along a
// border of voxels, and they hold its edges too. So one flat face speaks for those that meet it.
void reject_narrow(Model& model) noexcept {
  for (WallSegment& s : model.segments) {
    if (!s.accepted || !s.narrow || is_on_wider(model, s)) continue;
    const auto meets_flat = [&](const WallSegment& other) {
      return other.accepted && other.narrow && is_flat(model, other) &&
             !is_too_short(model, other) && meets(model, s, other);
    };
    const auto meets_rejected = [&](const WallSegment& other) {
      return !other.accepted && meets(model, s, other);
    };
    const auto any = [&](const auto& test) {
      return std::any_of(model.segments.begin(), model.segments.end(), test);
    };
    s.accepted =
        !is_too_short(model, s) && !any(meets_rejected) && (!is_round(model, s) || any(meets_flat));
  }
}

}  // namespace

void reject_furniture(Model& model) noexcept {
  for (int pass = 0; pass < kPasses; ++pass) {
    for (WallSegment& s : model.segments) {
      if (!s.accepted) continue;
      const bool tall = is_tall(model, s);
      for (std::size_t wall = 0; wall < model.planes.size() && s.accepted; ++wall) {
        if (wall != s.plane && stands_before(model, s, wall, tall)) {
          s.accepted = false;
          s.furniture = true;
        }
      }
      s.narrow = !tall && s.width_m() < kNarrowM;
    }
  }
  for (WallSegment& s : model.segments) {
    // Short things that hang are lamps; what is taller stands, and its foot is hidden. In a wall's
    // plane they are parts of it: panes, of which furniture hides the rest.
    if (s.accepted && s.bottom_m > model.floor_z + kHangingM && !std::isinf(model.floor_z) &&
        s.width_m() < kLeastBeamM && s.top_m - s.bottom_m < kTallestLampM &&
        !is_on_wider(model, s)) {
      s.accepted = false;
      s.furniture = s.width_m() < kNarrowM;
    }
  }
  for (WallSegment& s : model.segments) {
    s.accepted = s.accepted && !is_side(model, s);
  }
  reject_narrow(model);
}

}  // namespace convexcut::robust
