// SPDX-License-Identifier: Apache-2.0
//
// The one table of all configuration keys. Loading, checking, --set, the default file and the
// reference page are driven by it: a key is added here and in config.hpp, nowhere else.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "config/config.hpp"

namespace convexcut::config {

// A value as it is written in a file. Enumerations are their names.
using Value = std::variant<bool, std::int64_t, double, std::string>;

// What a key takes; all bounds are inclusive.
struct Boolean {};
struct Integer {
  std::int64_t min;
  std::int64_t max;
  enum class Notation : std::uint8_t { decimal, hexadecimal } notation = Notation::decimal;
};
struct Number {
  double min;
  double max;
};
struct Choice {
  std::span<const std::string_view> names;
};
struct Text {
  std::string_view expected;  // completes "expected …"
  bool (*accepts)(std::string_view) noexcept;
};
using Domain = std::variant<Boolean, Integer, Number, Choice, Text>;

struct Key {
  std::string_view name;  // "lidar.min_range_m": table, dot, key
  Domain domain;
  std::string_view unit;         // empty for what has none
  std::string_view description;  // one line
  Value (*get)(const Config&);
  void (*set)(Config&, const Value&);  // of a value that accept() has passed

  [[nodiscard]] std::string_view section() const { return name.substr(0, name.find('.')); }
  [[nodiscard]] std::string_view leaf() const { return name.substr(name.find('.') + 1); }
};

struct Section {
  std::string_view name;
  std::string_view description;
};

// Keys of one section are neighbours, sections come in the order of sections().
[[nodiscard]] std::span<const Key> keys() noexcept;
[[nodiscard]] std::span<const Section> sections() noexcept;
[[nodiscard]] const Key* find_key(std::string_view name) noexcept;  // null: there is none

// "a number 0 … 200", "one of auto, hdl32e", …
[[nodiscard]] std::string expected(const Domain& domain);

// The value as the key's type (an integer where a number is asked for becomes one), or nothing when
// it is of another type, out of range or not finite.
[[nodiscard]] std::optional<Value> accept(const Domain& domain, Value value);

// As TOML. Numbers are the shortest decimals that read back as the same double.
[[nodiscard]] std::string to_toml(const Value& value, const Domain& domain);

}  // namespace convexcut::config
