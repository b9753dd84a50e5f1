// SPDX-License-Identifier: Apache-2.0
//
// --set key=value. Does not prove that every program passes its --set options on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/loader.hpp"
#include "tests/config/config_error.hpp"

namespace convexcut::config {
namespace {

using test::errors_of;
using test::Overrides;
using ::testing::ElementsAre;

Config with(const Overrides& overrides) { return load(std::nullopt, overrides); }

TEST(Override, GoesBeforeTheFile) {
  const Config config =
      load_text("[lidar]\nmin_range_m = 3\n", "robot.toml", Overrides{"lidar.min_range_m=4"});
  EXPECT_EQ(config.lidar.min_range_m, 4.0);
}

TEST(Override, LastOneCounts) {
  EXPECT_EQ(with({"convex_cut.planes=1", "convex_cut.planes=2"}).convex_cut.planes, 2U);
}

TEST(Override, IsWrittenAsInToml) {
  EXPECT_EQ(with({"can.euler_id=0x122"}).can.euler_id, 0x122U);
  EXPECT_EQ(with({"lidar.time_offset_us=-1_000"}).lidar.time_offset_us, -1000);
  EXPECT_EQ(with({"lidar.min_range_m=5e-1"}).lidar.min_range_m, 0.5);
  EXPECT_TRUE(with({"lidar.vertical_offsets=true"}).lidar.vertical_offsets);
}

TEST(Override, TextNeedsNoQuotesButMayHaveThem) {
  EXPECT_EQ(with({"lidar.model=vlp16"}).lidar.model, LidarModel::vlp16);
  EXPECT_EQ(with({"lidar.model=\"vlp16\""}).lidar.model, LidarModel::vlp16);
  EXPECT_EQ(with({"dds.profile='/etc/x=1 #2.xml'"}).dds.profile, "/etc/x=1 #2.xml");
  EXPECT_EQ(with({"dds.profile=/etc/x=1 #2.xml"}).dds.profile, "/etc/x=1 #2.xml");
  EXPECT_EQ(with({"dds.profile="}).dds.profile, "");
}

TEST(Override, BlanksAroundKeyAndValueDoNotCount) {
  EXPECT_EQ(with({" lidar.model = vlp16 "}).lidar.model, LidarModel::vlp16);
  EXPECT_EQ(with({" convex_cut.planes = 7\n"}).convex_cut.planes, 7U);
}

TEST(Override, WrongTypeAndRangeAreErrorsAtTheirPlace) {
  EXPECT_THAT(
      errors_of("", {"lidar.min_range_m=abc", "lidar.min_range_m=-1", "convex_cut.planes=1.5",
                     "lidar.min_range_m=nan", "lidar.vertical_offsets=yes",
                     "convex_cut.planes=", "convex_cut.planes=\"9\""}),
      ElementsAre("--set lidar.min_range_m=abc: expected a number 0 … 200, found \"abc\"",
                  "--set lidar.min_range_m=-1: expected a number 0 … 200, found -1",
                  "--set convex_cut.planes=1.5: expected an integer 1 … 36000, found 1.5",
                  "--set lidar.min_range_m=nan: expected a number 0 … 200, found nan",
                  "--set lidar.vertical_offsets=yes: expected true or false, found \"yes\"",
                  "--set convex_cut.planes=: expected an integer 1 … 36000, found \"\"",
                  "--set convex_cut.planes=\"9\": expected an integer 1 … 36000, found \"9\""));
}

TEST(Override, WithoutEqualsSignIsAnError) {
  EXPECT_THAT(errors_of("", {"lidar.model", ""}),
              ElementsAre("--set lidar.model: expected key=value", "--set : expected key=value"));
}

TEST(Override, UnknownKeyIsAnErrorWithASuggestion) {
  EXPECT_THAT(errors_of("", {"lidar.modell=auto", "=1", "lidar=1"}),
              ElementsAre("--set lidar.modell=auto: unknown key; did you mean lidar.model?",
                          "--set =1: unknown key", "--set lidar=1: unknown key"));
}

TEST(Override, CannotSmuggleInAnotherKey) {
  EXPECT_THAT(errors_of("", {"convex_cut.planes=1\nother=2"}),
              ElementsAre("--set convex_cut.planes=1\\nother=2: expected an integer 1 … 36000, "
                          "found \"1\\nother=2\""));
}

TEST(Override, HasToBeUtf8AsAFileHasToBe) {
  EXPECT_EQ(with({"dds.profile=/etc/x\u00B4y.xml"}).dds.profile, "/etc/x\u00B4y.xml");
  EXPECT_THAT(errors_of("", {"dds.profile=/etc/x\xB4y.xml"}),
              ElementsAre("--set dds.profile=/etc/x\xB4y.xml: expected text in UTF-8"));
}

TEST(Override, BracketsAreNoTableAndNoArray) {
  EXPECT_THAT(errors_of("", {"convex_cut.planes=[1, 2]", "convex_cut.planes={ a = 1 }"}),
              ElementsAre("--set convex_cut.planes=[1, 2]: expected an integer 1 … 36000, found an "
                          "array",
                          "--set convex_cut.planes={ a = 1 }: expected an integer 1 … 36000, found "
                          "a table"));
}

}  // namespace
}  // namespace convexcut::config
