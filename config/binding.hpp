// SPDX-License-Identifier: Apache-2.0
//
// Ties a key to its field of Config: reading, writing, and a check while compiling that the field
// can hold all that the key takes.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "config/choices.hpp"
#include "config/config.hpp"
#include "config/schema.hpp"

namespace convexcut::config {
namespace detail {

template <class Field>
Value to_value(const Field& field) {
  if constexpr (std::same_as<Field, Degrees>) {
    return field.value;
  } else if constexpr (std::is_enum_v<Field>) {
    return std::string(name_of(field));
  } else if constexpr (std::integral<Field> && !std::same_as<Field, bool>) {
    return static_cast<std::int64_t>(field);
  } else {
    return field;
  }
}

template <class Field>
void from_value(const Value& value, Field& field) {
  if constexpr (std::same_as<Field, Degrees>) {
    field.value = std::get<double>(value);
  } else if constexpr (std::is_enum_v<Field>) {
    const auto* const found = std::ranges::find(kNames<Field>, std::get<std::string>(value));
    field = static_cast<Field>(found - kNames<Field>.begin());
  } else if constexpr (std::integral<Field> && !std::same_as<Field, bool>) {
    field = static_cast<Field>(std::get<std::int64_t>(value));
  } else {
    field = std::get<Field>(value);
  }
}

// Whether every value of the domain fits the field.
template <class Field>
constexpr bool suits(const Domain& domain) {
  if constexpr (std::same_as<Field, bool>) {
    return std::holds_alternative<Boolean>(domain);
  } else if constexpr (std::is_enum_v<Field>) {
    return std::holds_alternative<Choice>(domain);
  } else if constexpr (std::same_as<Field, std::string>) {
    return std::holds_alternative<Text>(domain);
  } else if constexpr (std::integral<Field>) {
    if (!std::holds_alternative<Integer>(domain)) return false;
    const auto& range = std::get<Integer>(domain);
    return std::in_range<Field>(range.min) && std::in_range<Field>(range.max);
  } else {
    static_assert(std::same_as<Field, double> || std::same_as<Field, Degrees>);
    return std::holds_alternative<Number>(domain);
  }
}

}  // namespace detail

template <auto SectionMember, auto FieldMember>
[[nodiscard]] constexpr Key bind_key(std::string_view name, const Domain& domain,
                                     std::string_view unit, std::string_view description) {
  using Field = std::remove_cvref_t<decltype((Config{}.*SectionMember).*FieldMember)>;
  // Evaluated while compiling, where a throw is an error.
  if (!detail::suits<Field>(domain)) throw "the domain of a key does not suit its field";
  return {
      name,
      domain,
      unit,
      description,
      [](const Config& config) { return detail::to_value((config.*SectionMember).*FieldMember); },
      [](Config& config, const Value& value) {
        detail::from_value(value, (config.*SectionMember).*FieldMember);
      }};
}

template <class Enum>
inline constexpr Choice kChoice{kNames<Enum>};

}  // namespace convexcut::config
