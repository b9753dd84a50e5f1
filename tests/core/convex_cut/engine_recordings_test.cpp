// SPDX-License-Identifier: Apache-2.0
//
// The engine on real clouds, with the default parameters. They are not levelled and carry no
// labels: this proves agreement with the reference, not that structure is found.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "core/convex_cut/engine.hpp"
#include "core/convex_cut/reference.hpp"
#include "tests/core/convex_cut/recorded_clouds.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut {
namespace {

void expect_reference_labels(const test::Cloud& cloud) {
  std::vector<Label> expected(cloud.size());
  ASSERT_EQ(reference::label({}, cloud.view(), expected), CutStatus::ok);
  const auto structure = std::ranges::count(expected, Label::structure);
  EXPECT_GT(structure, 0);
  EXPECT_LT(structure, static_cast<std::ptrdiff_t>(cloud.size()));
  testing::Test::RecordProperty("points", static_cast<int>(cloud.size()));
  testing::Test::RecordProperty("structure", static_cast<int>(structure));
  for (const unsigned threads : {1U, 2U, 3U, 4U}) {
    ConvexCutEngine engine({}, cloud.size(), threads);
    std::vector<Label> labels(cloud.size());
    ASSERT_EQ(engine.label(cloud.view(), labels), CutStatus::ok);
    EXPECT_EQ(labels, expected) << threads;
  }
}

TEST(EngineOnRecordings, BuildingPassage) {
  CONVEXCUT_NEEDS_RECORDING(file, "lidar/hdl32e_revolution.pcd");
  const test::Cloud cloud = test::read_pcd(file);
  ASSERT_GT(cloud.size(), 40'000U);
  expect_reference_labels(cloud);
}

TEST(EngineOnRecordings, RoomPanorama) {
  CONVEXCUT_LONG_TEST();
  CONVEXCUT_NEEDS_RECORDING(file, "room/room_panorama.pcd");
  const test::Cloud cloud = test::read_pcd(file);
  ASSERT_GT(cloud.size(), 100'000U);
  expect_reference_labels(cloud);
}

TEST(EngineOnRecordings, Courtyard) {
  CONVEXCUT_LONG_TEST();
  CONVEXCUT_NEEDS_RECORDING(file, "lidar/hdl32e_courtyard_2011.pcap");
  const std::vector<test::Cloud> revolutions = test::read_hdl32e_revolutions(file);
  ASSERT_EQ(revolutions.size(), 2U);
  EXPECT_EQ(revolutions[0].size(), 57'734U);
  EXPECT_EQ(revolutions[1].size(), 57'882U);
  for (const test::Cloud& cloud : revolutions) expect_reference_labels(cloud);
}

}  // namespace
}  // namespace convexcut
