// SPDX-License-Identifier: Apache-2.0
//
// Files as a whole: places, order and wording of errors. Does not prove that every text of the TOML
// library is helpful, only that it comes with its line and stays one line.
#include "config/loader.hpp"

#include <fstream>

#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/config/config_error.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::config {
namespace {

using test::errors_of;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

TEST(Loader, WithoutAFileThereAreTheDefaults) {
  const Config config = load(std::nullopt);
  EXPECT_EQ(config.convex_cut.planes, 360U);
  EXPECT_EQ(config.lidar.data_port, 2368);
}

TEST(Loader, TablesDottedKeysAndInlineTablesAreAlike) {
  EXPECT_EQ(load_text("[convex_cut]\nplanes = 90\n", "").convex_cut.planes, 90U);
  EXPECT_EQ(load_text("convex_cut.planes = 90\n", "").convex_cut.planes, 90U);
  EXPECT_EQ(load_text("convex_cut = { planes = 90 }\n", "").convex_cut.planes, 90U);
}

TEST(Loader, AllErrorsAreListedInTheOrderOfTheFile) {
  EXPECT_THAT(
      errors_of("[worker]\n"
                "period_ms = 5\n"
                "\n"
                "# a comment\n"
                "[lidar]\n"
                "min_range_m = \"abc\"\n"
                "model = 32\n"
                "max_rang_m = 3\n"
                "\n"
                "[convexcut]\n"
                "planes = 3\n"),
      ElementsAre("robot.toml:2: worker.period_ms: expected an integer 10 … 1000, found 5",
                  "robot.toml:6: lidar.min_range_m: expected a number 0 … 200, found \"abc\"",
                  "robot.toml:7: lidar.model: expected one of auto, hdl32e, vlp16, "
                  "puck_hires, vlp32c, found 32",
                  "robot.toml:8: lidar.max_rang_m: unknown key; did you mean "
                  "lidar.max_range_m?",
                  "robot.toml:10: convexcut: unknown table; did you mean convex_cut?"));
}

TEST(Loader, ErrorsOfTheFileAndOfOverridesComeTogether) {
  EXPECT_THAT(errors_of("[lidar]\nmodel = 'hdl64'\n", {"log.level=loud", "dds.domain"}),
              ElementsAre(StartsWith("robot.toml:2: lidar.model: "),
                          StartsWith("--set log.level=loud: "), StartsWith("--set dds.domain: ")));
}

TEST(Loader, UnknownKeyWithoutANearOneHasNoSuggestion) {
  EXPECT_THAT(errors_of("[lidar]\ncolour = 'red'\n"),
              ElementsAre("robot.toml:2: lidar.colour: unknown key"));
  EXPECT_THAT(errors_of("[" + std::string(1000, 'x') + "]\n"),
              ElementsAre("robot.toml:1: " + std::string(1000, 'x') + ": unknown table"));
}

TEST(Loader, KeyOfAnotherTableIsSuggested) {
  EXPECT_THAT(errors_of("[lidar]\nplanes = 3\n"),
              ElementsAre("robot.toml:2: lidar.planes: unknown key; did you mean "
                          "convex_cut.planes?"));
  EXPECT_THAT(errors_of("planes = 3\n"),
              ElementsAre("robot.toml:1: planes: unknown key; did you mean convex_cut.planes?"));
}

TEST(Loader, TableInPlaceOfAKeyAndKeyInPlaceOfATable) {
  EXPECT_THAT(errors_of("[lidar.model]\nname = 'x'\n"),
              ElementsAre(AllOf(StartsWith("robot.toml:1: lidar.model: expected one of auto"),
                                HasSubstr("found a table"))));
  EXPECT_THAT(errors_of("lidar = 3\n"),
              ElementsAre("robot.toml:1: lidar: expected a table, [lidar]"));
  EXPECT_THAT(errors_of("[[lidar]]\nmodel = 'auto'\n"),
              ElementsAre("robot.toml:1: lidar: expected a table, [lidar]"));
}

TEST(Loader, SyntaxErrorHasItsLine) {
  EXPECT_THAT(errors_of("[lidar]\nmodel = \n"),
              ElementsAre(StartsWith("robot.toml:2: not valid TOML: ")));
  EXPECT_THAT(errors_of("[lidar]\nmodel = 'auto'\nmodel = 'vlp16'\n"),
              ElementsAre(StartsWith("robot.toml:3: not valid TOML: ")));
  EXPECT_THAT(errors_of("\xFF\xFE"), ElementsAre(StartsWith("robot.toml:1: not valid TOML: ")));
}

TEST(Loader, SyntaxErrorHidesNoErrorOfAnOverrideAndMakesNoConflict) {
  // The file may well have set the range that the override conflicts with.
  EXPECT_THAT(errors_of("= 1\n", {"lidar.min_range_m=150", "log.level=loud"}),
              ElementsAre(StartsWith("robot.toml:1: not valid TOML: "),
                          StartsWith("--set log.level=loud: ")));
}

TEST(Loader, ControlCharactersOfTheInputDoNotReachAMessage) {
  EXPECT_THAT(errors_of("\"a\\nb\" = 1\n"), ElementsAre("robot.toml:1: a\\nb: unknown key"));
  EXPECT_THAT(errors_of("lidar.model = \"a\\nb\\u001b[31m\"\n"),
              ElementsAre(HasSubstr("found \"a\\nb\\u001B[31m\"")));
}

TEST(Loader, LongTextIsShownShortened) {
  const std::vector<std::string> errors =
      errors_of("lidar.model = \"" + std::string(100'000, 'a') + "\"\n");
  ASSERT_THAT(errors, SizeIs(1));
  EXPECT_LT(errors[0].size(), 300U);
  EXPECT_THAT(errors[0], HasSubstr("aaa…\""));
}

TEST(Loader, ShortenedTextEndsWithAWholeCharacter) {
  std::string text(59, 'a');
  for (int i = 0; i < 10; ++i) text += "°";  // two bytes each, the limit falls between them
  EXPECT_THAT(errors_of("lidar.model = '" + text + "'\n"),
              ElementsAre(HasSubstr(std::string(59, 'a') + "…\"")));
}

std::string error_of_file(const std::filesystem::path& file) {
  try {
    static_cast<void>(load(file));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(LoaderFile, IsReadAndNamedInErrors) {
  const test::TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "robot.toml";
  std::ofstream(file) << "[dds]\ndomain = 7\n";
  EXPECT_EQ(load(file).dds.domain, 7U);
  std::ofstream(file) << "[dds]\ndomain = 777\n";
  EXPECT_EQ(error_of_file(file),
            file.string() + ":2: dds.domain: expected an integer 0 … 232, found 777");
}

TEST(LoaderFile, EmptyFileGivesTheDefaults) {
  const test::TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "robot.toml";
  std::ofstream(file) << "";
  EXPECT_EQ(error_of_file(file), "no error");
}

TEST(LoaderFile, MissingFileAndDirectoryAreErrors) {
  const test::TemporaryDirectory folder;
  const std::string missing = (folder.path() / "none.toml").string();
  EXPECT_EQ(error_of_file(missing), missing + ": cannot open: No such file or directory");
  EXPECT_EQ(error_of_file(folder.path()),
            folder.path().string() + ": is a directory, expected a configuration file");
}

// Root can read everything: its rights are laid down meanwhile.
class AsNobody {
 public:
  AsNobody() {
    if (user_ == 0 && ::seteuid(kNobody) != 0) ADD_FAILURE() << "cannot become another user";
  }
  ~AsNobody() {
    if (::seteuid(user_) != 0) ADD_FAILURE() << "cannot become root again";
  }
  AsNobody(const AsNobody&) = delete;
  AsNobody& operator=(const AsNobody&) = delete;

 private:
  static constexpr ::uid_t kNobody = 65'534;
  ::uid_t user_ = ::geteuid();
};

TEST(LoaderFile, UnreadableFileIsAnError) {
  const test::TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "robot.toml";
  std::ofstream(file) << "";
  std::filesystem::permissions(file, std::filesystem::perms::none);
  std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
  const AsNobody nobody;
  EXPECT_EQ(error_of_file(file), file.string() + ": cannot open: Permission denied");
}

TEST(LoaderFile, ErrorsOfOverridesAreListedWithAMissingFile) {
  try {
    static_cast<void>(load("/none.toml", test::Overrides{"log.level=loud"}));
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/none.toml: cannot open"));
    EXPECT_THAT(error.what(), HasSubstr("\n--set log.level=loud: "));
  }
}

TEST(LoaderFile, AFileThatIsNoConfigurationByItsSizeIsNotReadToItsEnd) {
  const test::TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "robot.toml";
  std::ofstream(file) << "x";
  std::filesystem::resize_file(file, (1U << 20U) + 1);
  EXPECT_THAT(error_of_file(file), HasSubstr(": is larger than 1 MiB"));
}

}  // namespace
}  // namespace convexcut::config
