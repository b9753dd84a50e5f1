// SPDX-License-Identifier: Apache-2.0
#include "config/schema.hpp"

#include <algorithm>
#include <utility>

#include "config/value_text.hpp"

namespace convexcut::config {
namespace {

std::string joined(std::span<const std::string_view> names) {
  std::string text;
  for (const std::string_view name : names) {
    if (!text.empty()) text += ", ";
    text += name;
  }
  return text;
}

// One overload for each kind of domain, for std::visit.

std::string expectation(const Boolean&) { return "true or false"; }
std::string expectation(const Integer& d) {
  return concat("an integer ", integer_text(d.min, d.notation), " … ",
                integer_text(d.max, d.notation));
}
std::string expectation(const Number& d) {
  return concat("a number ", number_text(d.min), " … ", number_text(d.max));
}
std::string expectation(const Choice& d) {
  return concat(d.names.size() == 1 ? "" : "one of ", joined(d.names));
}
std::string expectation(const Text& d) { return std::string(d.expected); }

bool admits(const Boolean&, const Value& value) { return std::holds_alternative<bool>(value); }
bool admits(const Integer& d, const Value& value) {
  const auto* integer = std::get_if<std::int64_t>(&value);
  return integer != nullptr && *integer >= d.min && *integer <= d.max;
}
bool admits(const Number& d, const Value& value) {
  const auto* number = std::get_if<double>(&value);
  return number != nullptr && *number >= d.min && *number <= d.max;  // false for NaN as well
}
bool admits(const Choice& d, const Value& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text != nullptr && std::ranges::find(d.names, *text) != d.names.end();
}
bool admits(const Text& d, const Value& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text != nullptr && d.accepts(*text);
}

std::string toml_number(double value) {
  std::string text = number_text(value);
  // TOML tells a float by its point or exponent; nan and inf have neither.
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

}  // namespace

const Key* find_key(std::string_view name) noexcept {
  const std::span<const Key> all = keys();
  const auto found = std::ranges::find(all, name, &Key::name);
  return found == all.end() ? nullptr : &*found;
}

std::string expected(const Domain& domain) {
  return std::visit([](const auto& d) { return expectation(d); }, domain);
}

std::optional<Value> accept(const Domain& domain, Value value) {
  if (std::holds_alternative<Number>(domain) && std::holds_alternative<std::int64_t>(value)) {
    value = static_cast<double>(std::get<std::int64_t>(value));
  }
  const bool admitted = std::visit([&](const auto& d) { return admits(d, value); }, domain);
  return admitted ? std::optional(std::move(value)) : std::nullopt;
}

std::string to_toml(const Value& value, const Domain& domain) {
  if (const auto* boolean = std::get_if<bool>(&value)) return *boolean ? "true" : "false";
  if (const auto* number = std::get_if<double>(&value)) return toml_number(*number);
  if (const auto* text = std::get_if<std::string>(&value)) return toml_string(*text);
  const auto* range = std::get_if<Integer>(&domain);
  return integer_text(std::get<std::int64_t>(value),
                      range != nullptr ? range->notation : Integer::Notation::decimal);
}

}  // namespace convexcut::config
