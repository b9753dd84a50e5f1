// SPDX-License-Identifier: Apache-2.0
//
// One table of a scene file. Each reader names a key and what it takes; what does not fit is
// reported and counts as not there. finish() reports the keys that nobody has asked for.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "core/angle.hpp"
#include "core/geometry.hpp"
#include "core/time.hpp"
#include "replay/simulation/scene/problems.hpp"

namespace convexcut::simulation {

// Of a number; inclusive, but that `above` excludes the lower end.
struct Range {
  double low;
  double high;
  bool above = false;
};

inline constexpr Range kCoordinateRange{-500.0, 500.0};
inline constexpr Range kSizeRange{0.0, 1000.0, true};
inline constexpr Range kAngleRange{-360.0, 360.0};
inline constexpr Range kPartRange{0.0, 1.0};
inline constexpr Range kSpeedRange{0.0, 100.0, true};
inline constexpr Range kSecondsRange{0.0, 86400.0};

class Fields {
 public:
  // `name` goes before the names of keys in messages: "box" gives "box.min".
  Fields(const toml::table& table, std::string name, Problems& problems)
      : table_(&table), name_(std::move(name)), problems_(&problems) {}

  [[nodiscard]] bool has(std::string_view key) const { return table_->contains(key); }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] std::size_t line() const noexcept { return table_->source().begin.line; }
  [[nodiscard]] std::size_t line_of(std::string_view key) const;

  // Nothing where the key is missing, which is reported.
  std::optional<double> number(std::string_view key, Range range);
  std::optional<Vec3> point(std::string_view key, Range range = kCoordinateRange);
  std::optional<std::string> text(std::string_view key, std::string_view expected);
  // At least `least` rows of `columns` numbers; empty where they are not.
  std::vector<std::vector<double>> rows(std::string_view key, std::size_t columns,
                                        std::size_t least, Range range = kCoordinateRange);

  // The other value where the key is missing.
  double number_or(std::string_view key, Range range, double otherwise);
  int whole_number_or(std::string_view key, int low, int high, int otherwise);
  bool flag_or(std::string_view key, bool otherwise);
  Vec3 point_or(std::string_view key, const Vec3& otherwise);
  std::string text_or(std::string_view key, std::string otherwise);
  Degrees degrees_or(std::string_view key, double otherwise) {
    return {number_or(key, kAngleRange, otherwise)};
  }
  Duration seconds_or(std::string_view key, double otherwise);
  // As many numbers as `count`; nothing where they are not (reported) or missing (not reported).
  std::optional<std::vector<double>> numbers_if_any(std::string_view key, std::size_t count,
                                                    Range range);
  std::vector<std::string> texts_if_any(std::string_view key);

  template <class Choice, std::size_t count>
  Choice choice_or(std::string_view key,
                   const std::array<std::pair<std::string_view, Choice>, count>& names,
                   Choice otherwise) {
    const toml::node* node = find(key);
    if (node == nullptr) return otherwise;
    std::string expected = "one of";
    for (const auto& [name, choice] : names) {
      if (node->value<std::string_view>() == name) return choice;
      expected.append(expected.back() == 'f' && &name == &names.front().first ? " " : ", ")
          .append(name);
    }
    expect(key, *node, expected);
    return otherwise;
  }

  // An array of tables, or a table; none where the key is missing.
  std::vector<Fields> tables(std::string_view key);
  std::optional<Fields> table(std::string_view key);
  // All tables in this one, which has no other keys.
  std::vector<std::pair<std::string, Fields>> named_tables();

  void report(std::string_view key, std::string_view what);
  void report_missing(std::string_view key, std::string_view expected);
  // Unknown keys. Call it when all have been asked for.
  void finish();

 private:
  const toml::node* find(std::string_view key);
  [[nodiscard]] std::string full(std::string_view key) const;
  void expect(std::string_view key, const toml::node& node, std::string_view expected);
  static std::optional<double> as_number(const toml::node& node, Range range);
  static std::optional<std::vector<double>> as_numbers(const toml::node& node, std::size_t count,
                                                       Range range);

  const toml::table* table_;
  std::string name_;
  Problems* problems_;
  std::vector<std::string> asked_;
};

}  // namespace convexcut::simulation
