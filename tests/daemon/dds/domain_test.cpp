// SPDX-License-Identifier: Apache-2.0
//
// Does not prove that the built-in profile finds peers on a real network: tests stay on loopback.
// docs/design/dds.md has the table of what was tried by hand.
#include "daemon/dds/domain.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/dds/participant.hpp"
#include "support/test_domain.hpp"

namespace convexcut::daemon {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::test_settings;

std::string error_of(const config::Dds& settings) {
  try {
    const Participant participant(settings);
  } catch (const DdsError& error) {
    return error.what();
  }
  return "";
}

class ProfileTest : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  config::Dds with_profile(std::string_view text) {
    std::ofstream(path_) << text;
    config::Dds settings = test_settings();
    settings.profile = path_.string();
    return settings;
  }
  std::filesystem::path path_ = std::filesystem::temp_directory_path() /
                                ("convexcut-profile-" + std::to_string(::getpid()) + ".xml");
};

TEST(Domain, IsSharedByTheParticipantsOfAProcess) {
  const Participant first(test_settings());
  const Participant second(test_settings());
  EXPECT_EQ(first.domain(), second.domain());
  EXPECT_NE(first.handle(), second.handle());
}

TEST(Domain, CanBeOpenedAgainAfterItWasClosed) {
  for (int i = 0; i < 2; ++i) EXPECT_EQ(error_of(test_settings()), "");
}

TEST(Domain, NumberAboveTheLastIsRefusedWithTheRange) {
  config::Dds settings = test_settings();
  settings.domain = 233;
  EXPECT_THAT(error_of(settings), AllOf(HasSubstr("dds.domain: 233"), HasSubstr("0 … 232")));
}

TEST(Domain, IsNotOpenedASecondTimeWithAnotherProfile) {
  const Participant first(test_settings());
  config::Dds other = test_settings();
  other.profile = "";
  EXPECT_THAT(error_of(other), HasSubstr("already open with another profile"));
}

TEST(Domain, DoesNotReadTheUsersCycloneSettings) {
  ::setenv("CYCLONEDDS_URI", "<CycloneDDS><Domain><NoSuchElement/></Domain></CycloneDDS>", 1);
  EXPECT_EQ(error_of(test_settings()), "");
  ::unsetenv("CYCLONEDDS_URI");
}

TEST_F(ProfileTest, ThatIsMissingIsNamed) {
  config::Dds settings = test_settings();
  settings.profile = "/nonexistent/cyclone.xml";
  EXPECT_THAT(error_of(settings),
              AllOf(HasSubstr("dds.profile: cannot read"), HasSubstr("/nonexistent/cyclone.xml"),
                    HasSubstr("No such file")));
}

TEST_F(ProfileTest, ThatIsADirectoryIsRefused) {
  config::Dds settings = test_settings();
  settings.profile = "/";
  EXPECT_THAT(error_of(settings), HasSubstr("dds.profile"));
}

TEST_F(ProfileTest, ThatIsNotXmlIsRefused) {
  EXPECT_THAT(error_of(with_profile("domain = 0\n")), HasSubstr("not a Cyclone DDS XML file"));
  EXPECT_THAT(error_of(with_profile("")), HasSubstr("not a Cyclone DDS XML file"));
}

TEST_F(ProfileTest, WithAnUnknownElementIsRefusedInOneLineThatNamesIt) {
  const config::Dds settings = with_profile(
      "<CycloneDDS><Domain id=\"any\"><General><NoSuchElement>1</NoSuchElement></General>"
      "</Domain></CycloneDDS>");
  EXPECT_THAT(error_of(settings), AllOf(HasSubstr(settings.profile), HasSubstr("NoSuchElement"),
                                        HasSubstr("(line 1)"), Not(HasSubstr("\n"))));
}

TEST_F(ProfileTest, WithAnUnknownInterfaceIsRefused) {
  EXPECT_THAT(error_of(with_profile("<CycloneDDS><Domain id=\"any\"><General><Interfaces>"
                                    "<NetworkInterface name=\"nosuchif0\"/></Interfaces></General>"
                                    "</Domain></CycloneDDS>")),
              HasSubstr("nosuchif0"));
}

TEST_F(ProfileTest, ThatFailedLeavesTheDomainFreeForAnother) {
  EXPECT_NE(error_of(with_profile("<CycloneDDS><Nonsense/></CycloneDDS>")), "");
  EXPECT_EQ(error_of(test_settings()), "");
}

}  // namespace
}  // namespace convexcut::daemon
