// SPDX-License-Identifier: Apache-2.0
//
// The documents that are made from the schema. Does not prove that their prose is right.
#include "config/reference.hpp"

#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/loader.hpp"
#include "config/schema.hpp"
#include "tests/config/config_error.hpp"

namespace convexcut::config {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string text_of(const std::string& path_in_source) {
  std::ifstream in(std::string(CONVEXCUT_SOURCE_DIR "/") + path_in_source);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void expect_equal(const Config& a, const Config& b) {
  for (const Key& key : keys()) EXPECT_EQ(key.get(a), key.get(b)) << key.name;
}

// Regenerate with convexcut-config-reference: see config/config_reference.cpp.
TEST(Reference, ShippedFileIsTheSchemas) {
  EXPECT_EQ(text_of("config/convexcut.toml"), to_toml(Config{}));
}

TEST(Reference, PageIsTheSchemas) {
  EXPECT_EQ(text_of("docs/configuration.md"), reference_markdown());
}

TEST(Reference, ShippedFileLoadsAsTheDefaults) {
  expect_equal(load(CONVEXCUT_SOURCE_DIR "/config/convexcut.toml"), Config{});
}

TEST(Reference, AnyConfigurationSurvivesBeingWritten) {
  Config config;
  config.lidar.model = LidarModel::puck_hires;
  config.lidar.min_range_m = 0.1 + 0.2;  // no short decimal
  config.lidar.max_range_m = 1e-7 + 1;
  config.lidar.time_offset_us = -3'600'000'000;
  config.lidar.vertical_offsets = true;
  config.mount.roll = Degrees{-1e-300};
  config.can.extended_ids = true;
  config.can.quaternion_id = 0x1FFFFFFF;
  config.dds.profile = "/a \"quoted\" \\ path/°";
  expect_equal(load_text(to_toml(config), "written.toml"), config);
}

TEST(Reference, EntryHasMeaningUnitRangeAndDefault) {
  Config config;
  config.lidar.min_range_m = 0.75;
  EXPECT_THAT(to_toml(config), HasSubstr("\n# Nearer returns are dropped.\n"
                                         "# a number 0 … 200 m; default 0.5\n"
                                         "min_range_m = 0.75\n"));
}

TEST(Reference, PageQuotesErrorsAsTheyAre) {
  const std::string page = reference_markdown();
  const std::vector<std::string> errors = test::errors_of(
      "[lidar]\nmin_range_m = \"near\"\n\n[convex_cut]\nplane = 3\n", {"worker.latency_ms=200"});
  ASSERT_EQ(errors.size(), 3U);
  for (const std::string& error : errors) EXPECT_THAT(page, HasSubstr("    " + error + "\n"));
}

}  // namespace
}  // namespace convexcut::config
