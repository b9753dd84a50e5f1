// SPDX-License-Identifier: Apache-2.0
//
// Every key of the table, through a file. Does not prove that a field does what its description
// says: that is for the modules that use it.
#include <algorithm>
#include <ostream>
#include <set>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/schema.hpp"
#include "config/value_text.hpp"
#include "core/convex_cut/parameters.hpp"
#include "tests/config/config_error.hpp"

namespace convexcut::config {

void PrintTo(const Key& key, std::ostream* out) { *out << key.name; }

namespace {

using test::errors_of;
using ::testing::ElementsAre;
using ::testing::StartsWith;

std::string assignment(const Key& key, const std::string& toml_value) {
  return concat("[", key.section(), "]\n", key.leaf(), " = ", toml_value, "\n");
}

// A value that the domain takes and that is not the default.
std::optional<Value> another(const Key& key) {
  const Value usual = key.get(Config{});
  std::vector<Value> candidates;
  if (std::holds_alternative<Boolean>(key.domain)) candidates = {true, false};
  if (const auto* d = std::get_if<Integer>(&key.domain)) {
    // CAN identifiers must not meet their neighbours.
    const std::int64_t step = d->notation == Integer::Notation::hexadecimal ? 0x100 : 1;
    candidates = {std::get<std::int64_t>(usual) + step, d->min};
  }
  if (std::holds_alternative<Number>(key.domain)) candidates = {std::get<double>(usual) + 0.0625};
  if (const auto* d = std::get_if<Choice>(&key.domain)) {
    for (const std::string_view name : d->names) candidates.emplace_back(std::string(name));
  }
  if (std::holds_alternative<Text>(key.domain)) {
    candidates = {std::string("other_value"), std::string("10.0.0.7"), std::string("239.1.2.3"),
                  std::string("0")};
  }
  for (const Value& candidate : candidates) {
    if (candidate != usual && accept(key.domain, candidate)) return candidate;
  }
  return std::nullopt;
}

// TOML that each type of key must refuse, without the range.
std::vector<std::string> wrong_types(const Domain& domain) {
  std::vector<std::string> all{"[1, 2]", "{ a = 1 }", "1979-05-27", "nan", "-inf"};
  if (!std::holds_alternative<Boolean>(domain)) all.emplace_back("true");
  const bool numeric =
      std::holds_alternative<Integer>(domain) || std::holds_alternative<Number>(domain);
  if (!numeric) all.insert(all.end(), {"1", "1.5"});
  if (std::holds_alternative<Integer>(domain)) all.emplace_back("100.0");
  const bool text = std::holds_alternative<Text>(domain) || std::holds_alternative<Choice>(domain);
  if (!text) all.insert(all.end(), {"\"100\"", "\"abc\""});
  return all;
}

std::vector<std::string> out_of_range(const Domain& domain) {
  if (const auto* d = std::get_if<Integer>(&domain)) {
    return {std::to_string(d->min - 1), std::to_string(d->max + 1), "-9223372036854775808",
            "9223372036854775807"};
  }
  if (const auto* d = std::get_if<Number>(&domain)) {
    return {std::to_string(d->min - 0.001), std::to_string(d->max + 0.001), "1e300"};
  }
  if (std::holds_alternative<Choice>(domain)) return {"\"\"", "\"automatic\"", "\"AUTO\""};
  if (std::holds_alternative<Text>(domain)) return {"\"a\\u0001b\""};
  return {};
}

class EachKey : public ::testing::TestWithParam<Key> {
 protected:
  static void expect_refused(const std::string& toml_value) {
    const Key& key = GetParam();
    EXPECT_THAT(errors_of(assignment(key, toml_value)),
                ElementsAre(StartsWith(concat("robot.toml:2: ", key.name, ": expected ",
                                              expected(key.domain), ", found "))))
        << toml_value;
  }
};

TEST_P(EachKey, KeepsItsDefaultWhenLeftOut) {
  const Key& key = GetParam();
  EXPECT_EQ(key.get(load_text("", "robot.toml")), key.get(Config{}));
}

TEST_P(EachKey, DefaultIsInItsRange) {
  const Key& key = GetParam();
  EXPECT_EQ(accept(key.domain, key.get(Config{})), key.get(Config{}));
}

TEST_P(EachKey, TakesAnotherValueAndChangesNothingElse) {
  const Key& key = GetParam();
  const std::optional<Value> value = another(key);
  ASSERT_TRUE(value) << "no other value is known here for " << key.name;
  const Config config = load_text(assignment(key, to_toml(*value, key.domain)), "robot.toml");
  for (const Key& each : keys()) {
    EXPECT_EQ(each.get(config), each.name == key.name ? *value : each.get(Config{})) << each.name;
  }
}

TEST_P(EachKey, RefusesOtherTypes) {
  for (const std::string& value : wrong_types(GetParam().domain)) expect_refused(value);
}

TEST_P(EachKey, RefusesValuesOutOfRange) {
  for (const std::string& value : out_of_range(GetParam().domain)) expect_refused(value);
}

TEST_P(EachKey, BoundsAreInclusive) {
  const Domain& domain = GetParam().domain;
  if (const auto* d = std::get_if<Integer>(&domain)) {
    EXPECT_TRUE(accept(domain, Value(d->min)));
    EXPECT_TRUE(accept(domain, Value(d->max)));
  }
  if (const auto* d = std::get_if<Number>(&domain)) {
    EXPECT_TRUE(accept(domain, Value(d->min)));
    EXPECT_TRUE(accept(domain, Value(d->max)));
  }
  if (const auto* d = std::get_if<Choice>(&domain)) {
    for (const std::string_view name : d->names) {
      EXPECT_TRUE(accept(domain, Value(std::string(name)))) << name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Key, EachKey, ::testing::ValuesIn(keys().begin(), keys().end()),
                         [](const auto& test) {
                           std::string name(test.param.name);
                           std::ranges::replace(name, '.', '_');
                           return name;
                         });

TEST(Key, NumberTakesAnInteger) {
  EXPECT_EQ(load_text("lidar.min_range_m = 2", "robot.toml").lidar.min_range_m, 2.0);
}

TEST(Key, IdentifierMayBeHexadecimal) {
  EXPECT_EQ(load_text("can.quaternion_id = 0x121", "robot.toml").can.quaternion_id, 0x121U);
}

TEST(Key, EveryFieldOfCorrespondingTypeIsReached) {
  const Config config = load_text(
      "lidar.model = 'vlp32c'\n"
      "lidar.cut = 'clock'\n"
      "lidar.dual_return = 'strongest'\n"
      "lidar.cut_azimuth_deg = -90\n"
      "mount.orientation = 'fixed'\n"
      "mount.roll_deg = 1.5\n"
      "imu.mount_yaw_deg = 180\n"
      "dds.reliability = 'best_effort'\n"
      "dds.structure_topic = 'robot_1/structure'\n"
      "log.level = 'debug'\n",
      "robot.toml");
  EXPECT_EQ(config.lidar.model, LidarModel::vlp32c);
  EXPECT_EQ(config.lidar.cut, CutMode::clock);
  EXPECT_EQ(config.lidar.dual_return, DualReturn::strongest);
  EXPECT_EQ(config.lidar.cut_azimuth, Degrees{-90.0});
  EXPECT_EQ(config.mount.orientation, MountOrientation::fixed);
  EXPECT_EQ(config.mount.roll, Degrees{1.5});
  EXPECT_EQ(config.imu.mount_yaw, Degrees{180.0});
  EXPECT_EQ(config.dds.reliability, Reliability::best_effort);
  EXPECT_EQ(config.dds.structure_topic, "robot_1/structure");
  EXPECT_EQ(config.log.level, LogLevel::debug);
}

// Converts to anything: the most initialisers that an aggregate takes is its number of fields.
struct Anything {
  template <class T>
  operator T() const;  // NOLINT(google-explicit-constructor,hicpp-explicit-conversions)
};
template <class Aggregate, class... Fields>
constexpr std::size_t count_fields(Fields... fields) {
  if constexpr (requires { Aggregate{fields..., Anything{}}; }) {
    return count_fields<Aggregate>(fields..., Anything{});
  } else {
    return sizeof...(fields);
  }
}

std::size_t keys_of(std::string_view section) {
  return static_cast<std::size_t>(std::ranges::count(keys(), section, &Key::section));
}

TEST(Schema, EveryFieldOfConfigHasAKey) {
  EXPECT_EQ(sections().size(), count_fields<Config>());
  EXPECT_EQ(keys_of("lidar"), count_fields<Lidar>());
  EXPECT_EQ(keys_of("mount"), count_fields<Mount>());
  EXPECT_EQ(keys_of("imu"), count_fields<Imu>());
  EXPECT_EQ(keys_of("can"), count_fields<Can>());
  EXPECT_EQ(keys_of("convex_cut"), count_fields<ConvexCut>());
  EXPECT_EQ(keys_of("worker"), count_fields<Worker>());
  EXPECT_EQ(keys_of("dds"), count_fields<Dds>());
  EXPECT_EQ(keys_of("record"), count_fields<Record>());
  EXPECT_EQ(keys_of("metrics"), count_fields<Metrics>());
  EXPECT_EQ(keys_of("log"), count_fields<Log>());
}

TEST(Schema, NamesAreUniqueAndEachHasASectionAndADescription) {
  std::set<std::string_view> names;
  for (const Key& key : keys()) {
    EXPECT_TRUE(names.insert(key.name).second) << key.name;
    EXPECT_NE(std::ranges::find(sections(), key.section(), &Section::name), sections().end());
    EXPECT_TRUE(key.description.ends_with('.')) << key.name;
    EXPECT_EQ(find_key(key.name), &key);
  }
}

TEST(Schema, NamesThatScriptsDependOnExistWithTheirDefaults) {
  const Config config;
  const auto text = [&](std::string_view name) {
    const Key* key = find_key(name);
    return key == nullptr ? std::string() : to_toml(key->get(config), key->domain);
  };
  const std::vector<std::pair<std::string_view, std::string>> contract{
      {"lidar.model", "\"auto\""},
      {"lidar.min_range_m", "0.5"},
      {"lidar.max_range_m", "100.0"},
      {"lidar.cut_azimuth_deg", "0.0"},
      {"lidar.cut", "\"revolution\""},
      {"lidar.time_offset_us", "0"},
      {"mount.orientation", "\"imu\""},
      {"mount.roll_deg", "0.0"},
      {"mount.pitch_deg", "0.0"},
      {"mount.yaw_deg", "0.0"},
      {"imu.mount_roll_deg", "0.0"},
      {"imu.mount_pitch_deg", "0.0"},
      {"imu.mount_yaw_deg", "0.0"},
      {"convex_cut.method", "\"paper\""},
      {"convex_cut.planes", "360"},
      {"convex_cut.half_width_m", "0.05"},
      {"convex_cut.hull_distance_m", "0.08"},
      {"worker.period_ms", "100"},
      {"worker.latency_ms", "10"},
      {"dds.domain", "0"},
      {"dds.profile", "\"\""},
  };
  for (const auto& [name, value] : contract) EXPECT_EQ(text(name), value) << name;
}

TEST(Schema, EngineTakesTheCornersOfItsRanges) {
  const auto planes = std::get<Integer>(find_key("convex_cut.planes")->domain);
  const auto width = std::get<Number>(find_key("convex_cut.half_width_m")->domain);
  const auto distance = std::get<Number>(find_key("convex_cut.hull_distance_m")->domain);
  EXPECT_TRUE(is_valid(ConvexCutParameters{.planes = static_cast<std::uint32_t>(planes.min),
                                           .half_width_m = width.min,
                                           .hull_distance_m = distance.min}));
  EXPECT_TRUE(is_valid(ConvexCutParameters{.planes = static_cast<std::uint32_t>(planes.max),
                                           .half_width_m = width.max,
                                           .hull_distance_m = distance.max}));
}

}  // namespace
}  // namespace convexcut::config
