// SPDX-License-Identifier: Apache-2.0
#include "config/schema.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "config/value_text.hpp"

namespace convexcut::config {
namespace {

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

std::string joined(std::span<const std::string_view> names) {
  std::string text;
  for (const std::string_view name : names) {
    if (!text.empty()) text += ", ";
    text += name;
  }
  return text;
}

template <class T>
std::optional<Value> within(T value, T min, T max) {
  return value >= min && value <= max ? std::optional<Value>(value) : std::nullopt;
}

std::optional<Value> accept_number(const Number& range, const Value& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) {
    return within(static_cast<double>(*integer), range.min, range.max);
  }
  const auto* number = std::get_if<double>(&value);
  if (number == nullptr || !std::isfinite(*number)) return std::nullopt;
  return within(*number, range.min, range.max);
}

}  // namespace

const Key* find_key(std::string_view name) noexcept {
  const std::span<const Key> all = keys();
  const auto found = std::ranges::find(all, name, &Key::name);
  return found == all.end() ? nullptr : &*found;
}

std::string expected(const Domain& domain) {
  return std::visit(Overloaded{
                        [](const Boolean&) -> std::string { return "true or false"; },
                        [](const Integer& d) {
                          return "an integer " + integer_text(d.min, d.notation) + " … " +
                                 integer_text(d.max, d.notation);
                        },
                        [](const Number& d) {
                          return "a number " + number_text(d.min) + " … " + number_text(d.max);
                        },
                        [](const Choice& d) {
                          return d.names.size() == 1 ? joined(d.names)
                                                     : "one of " + joined(d.names);
                        },
                        [](const Text& d) { return std::string(d.expected); },
                    },
                    domain);
}

std::optional<Value> accept(const Domain& domain, const Value& value) {
  const auto* text = std::get_if<std::string>(&value);
  const auto* integer = std::get_if<std::int64_t>(&value);
  return std::visit(
      Overloaded{
          [&](const Boolean&) {
            return std::holds_alternative<bool>(value) ? std::optional(value) : std::nullopt;
          },
          [&](const Integer& d) {
            return integer != nullptr ? within(*integer, d.min, d.max) : std::nullopt;
          },
          [&](const Number& d) { return accept_number(d, value); },
          [&](const Choice& d) {
            const bool known =
                text != nullptr && std::ranges::find(d.names, *text) != d.names.end();
            return known ? std::optional(value) : std::nullopt;
          },
          [&](const Text& d) {
            return text != nullptr && d.accepts(*text) ? std::optional(value) : std::nullopt;
          },
      },
      domain);
}

std::string to_toml(const Value& value, const Domain& domain) {
  return std::visit(Overloaded{
                        [](bool v) -> std::string { return v ? "true" : "false"; },
                        [&](std::int64_t v) {
                          const auto* range = std::get_if<Integer>(&domain);
                          return integer_text(
                              v, range != nullptr ? range->notation : Integer::Notation::decimal);
                        },
                        [](double v) {
                          std::string text = number_text(v);
                          // TOML tells a float by its point or exponent; nan and inf have neither.
                          if (text.find_first_of(".en") == std::string::npos) text += ".0";
                          return text;
                        },
                        [](const std::string& v) { return quoted(v); },
                    },
                    value);
}

}  // namespace convexcut::config
