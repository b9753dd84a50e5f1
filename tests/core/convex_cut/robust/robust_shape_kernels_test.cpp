// SPDX-License-Identifier: Apache-2.0
//
// Principal axes of sixteen neighbourhoods at once are those of Eigen's closed form. What shapes
// are taken where surfaces meet is robust_shape_test's.
#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <span>

#include <gtest/gtest.h>

#include "core/convex_cut/robust/shape_kernels.hpp"
#include "tests/core/convex_cut/every_simd_path.hpp"
#include "tests/support/effort.hpp"

namespace convexcut {
namespace {

// Points about the middle of a voxel: on a plane, a line, anywhere, or all of them one.
[[nodiscard]] robust::Moments random_moments(std::mt19937& random, int kind) {
  const auto any = [&](std::int32_t from, std::int32_t to) {
    return std::uniform_int_distribution<std::int32_t>(from, to)(random);
  };
  robust::Moments moments;
  for (int points = any(1, 9); points > 0; --points) {
    const std::int32_t along = any(-100, 100);
    const std::int32_t across = any(-100, 100);
    if (kind == 0) moments.add_mm(along, across, along / 4 - across / 7 + any(-9, 9));
    if (kind == 1) moments.add_mm(along / 3 + any(-3, 3), along + any(-3, 3), any(-3, 3));
    if (kind == 2) moments.add_mm(along, across, any(-100, 100));
    if (kind == 3) moments.add_mm(7, -7, 7);
    if (kind == 4) moments.add_mm(along, across, 0);
  }
  return moments;
}

struct ExpectedShape {
  robust::Shape shape = robust::Shape::other;
  Vec3f direction = Vec3f::Zero();
};

// Step by step in float, and by Eigen.
[[nodiscard]] ExpectedShape expected_shape(const robust::Around& around) {
  constexpr std::array<std::array<Eigen::Index, 2>, 6> kRowsAndColumns{
      {{0, 0}, {1, 0}, {2, 0}, {1, 1}, {2, 1}, {2, 2}}};
  float count = 0.0F;
  Vec3f sum = Vec3f::Zero();
  robust::Mat3f products = robust::Mat3f::Zero();
  for (std::size_t k = 0; k < around.count; ++k) {
    const robust::Moments& m = *around.moments[k];
    const int step = around.step[k];
    const Vec3f shift =
        Vec3f(static_cast<float>(step / 9 - 1), static_cast<float>(step / 3 % 3 - 1),
              static_cast<float>(step % 3 - 1)) *
        robust::kVoxelM;
    const auto n = static_cast<float>(m.count);
    const Vec3f own = Vec3f(static_cast<float>(m.sum_mm[0]), static_cast<float>(m.sum_mm[1]),
                            static_cast<float>(m.sum_mm[2])) *
                      1e-3F;
    count += n;
    sum += own + n * shift;
    for (std::size_t i = 0; i < 6; ++i) {
      const auto [r, c] = kRowsAndColumns[i];
      products(r, c) += static_cast<float>(m.products_mm2[i]) * 1e-6F + shift[r] * own[c] +
                        own[r] * shift[c] + n * shift[r] * shift[c];
      products(c, r) = products(r, c);
    }
  }
  if (count < 6.0F) return {};
  const Vec3f mean = sum / count;
  Eigen::SelfAdjointEigenSolver<robust::Mat3f> axes;
  axes.computeDirect(products / count - mean * mean.transpose());
  const Vec3f& extent2 = axes.eigenvalues();
  constexpr float kThickness2 = 0.035F * 0.035F;
  if (extent2[0] < kThickness2 && extent2[1] > 4.0F * std::max(extent2[0], 2e-4F)) {
    return {robust::Shape::plane, axes.eigenvectors().col(0)};
  }
  if (extent2[1] < 2.0F * kThickness2 && extent2[2] > 6.0F * extent2[1]) {
    return {robust::Shape::line, axes.eigenvectors().col(2)};
  }
  return {};
}

#ifdef EIGEN_VECTORIZE_NEON
constexpr bool kEigenHasPairs = true;
#else
constexpr bool kEigenHasPairs = false;
#endif

class RobustShapes : public test::EverySimdPath {};

TEST_P(RobustShapes, AreEigensBitByBit) {
  std::mt19937 random(9);
  std::array<std::size_t, 3> seen{};
  for (std::uint64_t round = 0; round < test::repetitions(1'000); ++round) {
    std::array<std::array<robust::Moments, robust::Around::kMost>, robust::kShapesAtOnce> moments;
    std::array<robust::Around, robust::kShapesAtOnce> around;
    const std::size_t count = 1 + random() % robust::kShapesAtOnce;
    for (std::size_t i = 0; i < count; ++i) {
      const int kind = static_cast<int>(random() % 5);
      const bool alone = random() % 4 == 0;
      for (std::uint8_t step = 0; step < robust::Around::kMost; ++step) {
        const bool is_middle = step == robust::Around::kMiddle;
        if (!is_middle && (alone || (kind == 0 && step % 3 != 1) || random() % 2 == 0)) continue;
        moments[i][step] = random_moments(random, kind);
        around[i].moments[around[i].count] = &moments[i][step];
        around[i].step[around[i].count++] = step;
      }
    }
    robust::ShapeColumns shapes;
    robust::take_shapes(std::span(around).first(count), shapes);
    for (std::size_t i = 0; i < count; ++i) {
      const ExpectedShape expected = expected_shape(around[i]);
      ++seen.at(static_cast<std::size_t>(expected.shape));
      ASSERT_EQ(shapes.is_plane[i] != 0, expected.shape == robust::Shape::plane);
      ASSERT_EQ(shapes.is_line[i] != 0, expected.shape == robust::Shape::line);
      if (expected.shape == robust::Shape::other) continue;
      const Vec3f direction(shapes.x[i], shapes.y[i], shapes.z[i]);
      // Eigen's own vectors of two (NEON) add three products in another order.
      ASSERT_LE((direction - expected.direction).cwiseAbs().maxCoeff(),
                kEigenHasPairs ? 1e-5F : 0.0F);
    }
  }
  for (const std::size_t shapes : seen) EXPECT_GT(shapes, test::repetitions(100));
}

CONVEXCUT_ON_EVERY_SIMD_PATH(RobustShapes);

}  // namespace
}  // namespace convexcut
