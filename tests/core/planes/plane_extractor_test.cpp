// SPDX-License-Identifier: Apache-2.0
//
// Plane patches of clouds whose planes are known. Does not prove how many planes of a real room are
// found: bench/planes counts those of a generated room.
#include "core/planes/plane_extractor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>

namespace convexcut {
namespace {

using ::testing::Each;
using ::testing::SizeIs;

constexpr double kNoise = 0.02;

// Points with the number of the sheet that each came from.
class Cloud {
 public:
  // `count` points evenly on a rectangle: corner + a·side_a + b·side_b, with noise across it.
  Cloud& sheet(Vec3 corner, Vec3 side_a, Vec3 side_b, int count, double noise = kNoise) {
    const Vec3 across = side_a.cross(side_b).normalized();
    std::normal_distribution<double> off(0.0, noise);
    for (int i = 0; i < count; ++i) {
      add(corner + even_(random_) * side_a + even_(random_) * side_b + off(random_) * across);
    }
    ++sheets_;
    return *this;
  }
  // Points anywhere in a box, of no sheet.
  Cloud& clutter(Vec3 low, Vec3 high, int count) {
    const int sheet = sheets_;
    sheets_ = kClutter;
    for (int i = 0; i < count; ++i) {
      const Vec3 t(even_(random_), even_(random_), even_(random_));
      add(low + t.cwiseProduct(high - low));
    }
    sheets_ = sheet;
    return *this;
  }
  void add(const Vec3& p) {
    x.push_back(static_cast<float>(p.x()));
    y.push_back(static_cast<float>(p.y()));
    z.push_back(static_cast<float>(p.z()));
    sheet_of.push_back(sheets_);
  }
  [[nodiscard]] CloudView view() const { return {x, y, z}; }

  static constexpr int kClutter = -1;
  std::vector<float> x, y, z;
  std::vector<int> sheet_of;

 private:
  std::mt19937_64 random_{7};
  std::uniform_real_distribution<double> even_{0.0, 1.0};
  int sheets_ = 0;
};

// The patch that has most points of a sheet, and its shares.
struct Match {
  std::uint32_t patch = kNoPatch;
  double recall = 0.0;     // of the sheet's points
  double precision = 0.0;  // of the patch's points
};

Match match(const Cloud& cloud, const PlanePatches& found, int sheet) {
  std::map<std::uint32_t, int> votes;
  int of_sheet = 0;
  for (std::size_t i = 0; i < cloud.sheet_of.size(); ++i) {
    if (cloud.sheet_of[i] != sheet) continue;
    ++of_sheet;
    if (found.patch_of_point[i] != kNoPatch) ++votes[found.patch_of_point[i]];
  }
  Match best;
  int most = 0;
  for (const auto& [patch, count] : votes) {
    if (count <= most) continue;
    most = count;
    best.patch = patch;
  }
  if (most == 0) return best;
  best.recall = static_cast<double>(most) / of_sheet;
  best.precision = static_cast<double>(most) / found.patches[best.patch].points;
  return best;
}

double angle_deg(const Vec3& a, const Vec3& b) {
  return to_degrees({std::acos(std::min(1.0, std::abs(a.normalized().dot(b.normalized()))))}).value;
}

TEST(PlaneExtractor, FindsASinglePlaneWithItsNormalOffsetAndSize) {
  const Vec3 normal = Vec3(1.0, 2.0, 0.5).normalized();
  const Vec3 a = normal.unitOrthogonal() * 3.0;
  const Vec3 b = normal.cross(a).normalized() * 2.0;
  Cloud cloud;
  cloud.sheet(normal * 2.5 - a / 2 - b / 2, a, b, 3000);
  PlaneExtractor extractor;
  const PlanePatches found = extractor.extract(cloud.view());
  ASSERT_THAT(found.patches, SizeIs(1));
  const PlanePatch& patch = found.patches[0];
  EXPECT_LT(angle_deg(patch.plane.normal, normal), 0.2);
  EXPECT_NEAR(patch.plane.offset_m, 2.5, 0.003);
  EXPECT_NEAR(patch.plane.normal.norm(), 1.0, 1e-12);
  EXPECT_LT((patch.centroid - normal * 2.5).norm(), 0.1);
  EXPECT_NEAR(patch.length_m, 3.0, 0.1);
  EXPECT_NEAR(patch.width_m, 2.0, 0.1);
  EXPECT_NEAR(patch.rms_m, kNoise, 0.002);
  EXPECT_GT(patch.points, 2950U);  // 3 σ
}

TEST(PlaneExtractor, SeparatesTheSixSidesOfARoom) {
  Cloud cloud;
  const Vec3 x(6, 0, 0), y(0, 5, 0), z(0, 0, 2.7);
  const Vec3 low(-2.9, -2.1, -1.1);
  cloud.sheet(low, x, y, 6000).sheet(low + z, x, y, 6000).sheet(low, x, z, 4000);
  cloud.sheet(low + y, x, z, 4000).sheet(low, y, z, 4000).sheet(low + x, y, z, 4000);
  PlaneExtractor extractor;
  const PlanePatches found = extractor.extract(cloud.view());
  EXPECT_THAT(found.patches, SizeIs(6));
  const std::vector<Vec3> normals{Vec3::UnitZ(), Vec3::UnitZ(), Vec3::UnitY(),
                                  Vec3::UnitY(), Vec3::UnitX(), Vec3::UnitX()};
  for (int sheet = 0; sheet < 6; ++sheet) {
    const Match m = match(cloud, found, sheet);
    ASSERT_NE(m.patch, kNoPatch);
    EXPECT_GT(m.recall, 0.95) << sheet;
    EXPECT_GT(m.precision, 0.95) << sheet;
    EXPECT_LT(
        angle_deg(found.patches[m.patch].plane.normal, normals[static_cast<std::size_t>(sheet)]),
        0.3);
  }
}

TEST(PlaneExtractor, OutliersDoNotBendAPlane) {
  Cloud cloud;
  cloud.sheet({-2, 3, -1}, {4, 0, 0}, {0, 0, 2.5}, 3000);
  cloud.clutter({-2, 1, -1}, {2, 5, 1.5}, 1500);
  PlaneExtractor extractor;
  const PlanePatches found = extractor.extract(cloud.view());
  const Match m = match(cloud, found, 0);
  ASSERT_EQ(m.patch, 0U);
  EXPECT_GT(m.recall, 0.95);
  EXPECT_LT(angle_deg(found.patches[0].plane.normal, Vec3::UnitY()), 0.3);
  EXPECT_NEAR(found.patches[0].plane.offset_m, 3.0, 0.004);
}

TEST(PlaneExtractor, ClutterIsNoPlane) {
  Cloud cloud;
  cloud.clutter({-3, -3, -1}, {3, 3, 2}, 20'000);
  PlaneExtractor extractor;
  const PlanePatches found = extractor.extract(cloud.view());
  // By chance a few points may lie well: one in two hundred at most.
  EXPECT_GT(std::ranges::count(found.patch_of_point, kNoPatch), 19'900);
}

TEST(PlaneExtractor, ParallelPlanesApartAreTwo) {
  // 0.25 m: a cupboard before a wall.
  Cloud cloud;
  cloud.sheet({-2, 3.0, -1}, {4, 0, 0}, {0, 0, 2.5}, 3000);
  cloud.sheet({-0.5, 2.75, -1}, {1, 0, 0}, {0, 0, 2}, 1000);
  PlaneExtractor extractor;
  const PlanePatches found = extractor.extract(cloud.view());
  ASSERT_THAT(found.patches, SizeIs(2));
  EXPECT_GT(match(cloud, found, 0).recall, 0.97);
  EXPECT_GT(match(cloud, found, 1).recall, 0.97);
  EXPECT_NE(match(cloud, found, 0).patch, match(cloud, found, 1).patch);
}

TEST(PlaneExtractor, PlanesThatMeetAtAnObtuseAngleAreTwo) {
  // A ceiling that bends by 20°.
  Cloud cloud;
  const double bend = Degrees{20.0}.to_radians().value;
  cloud.sheet({0, -2, 2}, {-2.5, 0, 0}, {0, 4, 0}, 3000);
  cloud.sheet({0, -2, 2}, {2.5 * std::cos(bend), 0, -2.5 * std::sin(bend)}, {0, 4, 0}, 3000);
  PlaneExtractor extractor;
  const PlanePatches found = extractor.extract(cloud.view());
  ASSERT_THAT(found.patches, SizeIs(2));
  EXPECT_GT(match(cloud, found, 0).recall, 0.85);
  EXPECT_GT(match(cloud, found, 1).recall, 0.85);
  const double between = angle_deg(found.patches[0].plane.normal, found.patches[1].plane.normal);
  EXPECT_NEAR(between, 20.0, 1.0);
}

TEST(PlaneExtractor, PiecesOfOnePlaneFarApartAreTwoPatches) {
  Cloud cloud;
  cloud.sheet({-5, 3, -1}, {2, 0, 0}, {0, 0, 2}, 1000)
      .sheet({2, 3, -1}, {2, 0, 0}, {0, 0, 2}, 1000);
  PlaneExtractor extractor;
  const PlanePatches found = extractor.extract(cloud.view());
  ASSERT_THAT(found.patches, SizeIs(2));
  EXPECT_NE(match(cloud, found, 0).patch, match(cloud, found, 1).patch);
}

TEST(PlaneExtractor, AHoleDoesNotSplitAPlane) {
  // A wall above and beside a window, joined below it.
  Cloud cloud;
  cloud.sheet({-3, 3, -1}, {2, 0, 0}, {0, 0, 2.5}, 1500)
      .sheet({1, 3, -1}, {2, 0, 0}, {0, 0, 2.5}, 1500);
  cloud.sheet({-1, 3, -1}, {2, 0, 0}, {0, 0, 0.9}, 500);
  PlaneExtractor extractor;
  EXPECT_THAT(extractor.extract(cloud.view()).patches, SizeIs(1));
}

TEST(PlaneExtractor, FindsASmallPatchOnItsOwn) {
  // A monitor 0.5 × 0.35 m before the room's walls.
  Cloud cloud;
  cloud.sheet({-3, 4, -1}, {6, 0, 0}, {0, 0, 2.5}, 6000)
      .sheet({-3, -2, -1}, {6, 0, 0}, {0, 6, 0}, 6000);
  cloud.sheet({0.3, 1.6, -0.2}, {0.5, 0, 0}, {0, 0.05, 0.35}, 90, 0.01);
  PlaneExtractor extractor;
  const PlanePatches found = extractor.extract(cloud.view());
  const Match m = match(cloud, found, 2);
  ASSERT_NE(m.patch, kNoPatch);
  EXPECT_GT(m.recall, 0.9);
  EXPECT_GT(m.precision, 0.9);
}

TEST(PlaneExtractor, FollowsAPlaneAlongBeamsThatAreFarApart) {
  // Rings of a lidar on the floor, 0.25 to 0.5 m from one to the next: no cell below 1 m has a
  // plane.
  Cloud cloud;
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 0.01);
  for (double radius = 2.0, step = 0.25; radius < 5.0; radius += step, step *= 1.1) {
    for (int i = 0; i < 1000; ++i) {
      const double angle = 2e-3 * std::numbers::pi * i;
      cloud.add({radius * std::cos(angle), radius * std::sin(angle), -1.1 + noise(random)});
    }
  }
  PlaneExtractor extractor;
  const PlanePatches found = extractor.extract(cloud.view());
  ASSERT_THAT(found.patches, SizeIs(1));
  EXPECT_GT(match(cloud, found, 0).recall, 0.98);
}

TEST(PlaneExtractor, OneBeamIsNoPlane) {
  Cloud cloud;
  for (int i = 0; i < 2000; ++i) cloud.add({-3.0 + 0.003 * i, 4.0, 0.5});
  PlaneExtractor extractor;
  EXPECT_THAT(extractor.extract(cloud.view()).patches, SizeIs(0));
}

TEST(PlaneExtractor, NothingAndDegenerateCloudsGiveNoPatch) {
  PlaneExtractor extractor;
  EXPECT_THAT(extractor.extract({}).patches, SizeIs(0));
  Cloud same;
  for (int i = 0; i < 500; ++i) same.add({1, 2, 3});
  const PlanePatches found = extractor.extract(same.view());
  EXPECT_THAT(found.patches, SizeIs(0));
  EXPECT_THAT(found.patch_of_point, SizeIs(500));
  EXPECT_THAT(found.patch_of_point, Each(kNoPatch));
}

TEST(PlaneExtractor, PointsThatAreNoMeasurementAreInNoPatch) {
  Cloud cloud;
  cloud.sheet({-2, 3, -1}, {4, 0, 0}, {0, 0, 2.5}, 2000);
  cloud.add({std::numeric_limits<double>::quiet_NaN(), 3.0, 0.0});
  cloud.add({0.0, std::numeric_limits<double>::infinity(), 0.0});
  cloud.add({0.0, 3.0, -1e30});
  PlaneExtractor extractor;
  const PlanePatches found = extractor.extract(cloud.view());
  ASSERT_THAT(found.patches, SizeIs(1));
  ASSERT_THAT(found.patch_of_point, SizeIs(2003));
  for (std::size_t i = 2000; i < 2003; ++i) EXPECT_EQ(found.patch_of_point[i], kNoPatch);
}

TEST(PlaneExtractor, AllOfAPatchSaysIsTrueOfItsPoints) {
  Cloud cloud;
  cloud.sheet({-3, 4, -1}, {6, 0, 0}, {0, 0, 2.5}, 4000)
      .sheet({-3, -2, -1}, {6, 0, 0}, {0, 6, 0}, 4000);
  cloud.clutter({-3, -2, -1}, {3, 4, 1.5}, 2000);
  PlaneExtractor extractor;
  const PlanePatches found = extractor.extract(cloud.view());
  std::vector<std::uint32_t> counted(found.patches.size());
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    const std::uint32_t patch = found.patch_of_point[i];
    if (patch == kNoPatch) continue;
    ASSERT_LT(patch, found.patches.size());
    ++counted[patch];
    const Vec3 p = Eigen::Vector3f(cloud.x[i], cloud.y[i], cloud.z[i]).cast<double>();
    // 3 σ from the plane before the last refit.
    EXPECT_LT(std::abs(found.patches[patch].plane.signed_distance_m(p)), 0.065);
  }
  for (std::size_t i = 0; i < found.patches.size(); ++i) {
    EXPECT_EQ(found.patches[i].points, counted[i]);
    EXPECT_GE(found.patches[i].plane.offset_m, 0.0);
  }
  EXPECT_TRUE(std::ranges::is_sorted(counted, std::ranges::greater{}));
}

TEST(PlaneExtractor, AnExtractorThatWasUsedGivesWhatANewOneGives) {
  Cloud first, second;
  first.sheet({-3, 4, -1}, {6, 0, 0}, {0, 0, 2.5}, 9000).clutter({-3, 0, -1}, {3, 4, 1}, 1000);
  second.sheet({2, -3, -1}, {0, 6, 0}, {0, 0, 2.5}, 2000)
      .sheet({2, -3, -1}, {0, 6, 0}, {3, 0, 0}, 2000);
  PlaneExtractor used;
  static_cast<void>(used.extract(first.view()));
  const PlanePatches again = used.extract(second.view());
  PlaneExtractor fresh;
  const PlanePatches once = fresh.extract(second.view());
  ASSERT_EQ(again.patches.size(), once.patches.size());
  for (std::size_t i = 0; i < once.patches.size(); ++i) {
    EXPECT_EQ(again.patches[i].plane.normal, once.patches[i].plane.normal);
    EXPECT_EQ(again.patches[i].plane.offset_m, once.patches[i].plane.offset_m);
  }
  EXPECT_TRUE(std::ranges::equal(again.patch_of_point, once.patch_of_point));
}

TEST(PlaneExtractor, RefusesColumnsOfDifferentLengthAndBadOptions) {
  PlaneExtractor extractor;
  const std::vector<float> two(2), three(3);
  EXPECT_THROW(static_cast<void>(extractor.extract({two, three, two})), std::invalid_argument);
  EXPECT_THROW(PlaneExtractor({.noise_m = 0.0}), std::invalid_argument);
  EXPECT_THROW(PlaneExtractor({.least_cell_share = 0.2}), std::invalid_argument);
}

}  // namespace
}  // namespace convexcut
