// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/scene/fields.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "config/suggestion.hpp"
#include "config/value_text.hpp"

namespace convexcut::simulation {
namespace {

using config::concat;
using config::number_text;
using config::printable;

// As it is written, on one line.
std::string found_text(const toml::node& node) {
  constexpr std::size_t kShownBytes = 60;
  if (node.is_table()) return "a table";
  if (const auto* text = node.as_string()) {
    return concat("\"", printable(text->get(), kShownBytes), "\"");
  }
  std::ostringstream text;
  node.visit([&](const auto& value) { text << value; });
  std::string shown = text.str();
  std::ranges::replace(shown, '\n', ' ');
  return printable(shown, kShownBytes);
}

std::string range_text(Range range) {
  if (range.above) {
    return concat("above ", number_text(range.low), ", at most ", number_text(range.high));
  }
  return concat(number_text(range.low), " … ", number_text(range.high));
}

std::string numbers_text(std::size_t count, Range range) {
  return concat("an array of ", std::to_string(count), " numbers, each ", range_text(range));
}

}  // namespace

const toml::node* Fields::find(std::string_view key) {
  asked_.emplace_back(key);
  return table_->get(key);
}

std::string Fields::full(std::string_view key) const {
  if (key.empty()) return name_;
  return name_.empty() ? std::string(key) : concat(name_, ".", key);
}

std::size_t Fields::line_of(std::string_view key) const {
  for (const auto& [name, node] : *table_) {
    if (name.str() == key) return name.source().begin.line;
  }
  return line();
}

void Fields::report(std::string_view key, std::string_view what) {
  problems_->report(line_of(key), full(key), what);
}

void Fields::report_missing(std::string_view key, std::string_view expected) {
  report(key, concat("missing, expected ", expected));
}

void Fields::expect(std::string_view key, const toml::node& node, std::string_view expected) {
  const auto at = node.source().begin.line;
  problems_->report(at != 0 ? at : line_of(key), full(key),
                    concat("expected ", expected, ", found ", found_text(node)));
}

std::optional<double> Fields::as_number(const toml::node& node, Range range) {
  if (!node.is_number()) return std::nullopt;
  const std::optional<double> value = node.value<double>();
  if (!value || !std::isfinite(*value) || *value < range.low || *value > range.high ||
      (range.above && *value == range.low)) {
    return std::nullopt;
  }
  return value;
}

std::optional<std::vector<double>> Fields::as_numbers(const toml::node& node, std::size_t count,
                                                      Range range) {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != count) return std::nullopt;
  std::vector<double> numbers;
  for (const toml::node& element : *array) {
    const std::optional<double> number = as_number(element, range);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

std::optional<double> Fields::number(std::string_view key, Range range) {
  const toml::node* node = find(key);
  const std::string expected = "a number " + range_text(range);
  if (node == nullptr) {
    report_missing(key, expected);
    return std::nullopt;
  }
  const std::optional<double> value = as_number(*node, range);
  if (!value) expect(key, *node, expected);
  return value;
}

double Fields::number_or(std::string_view key, Range range, double otherwise) {
  if (!has(key)) {
    asked_.emplace_back(key);
    return otherwise;
  }
  return number(key, range).value_or(otherwise);
}

std::optional<std::vector<double>> Fields::numbers_if_any(std::string_view key, std::size_t count,
                                                          Range range) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto numbers = as_numbers(*node, count, range);
  if (!numbers) expect(key, *node, numbers_text(count, range));
  return numbers;
}

std::optional<Vec3> Fields::point(std::string_view key, Range range) {
  if (!has(key)) {
    asked_.emplace_back(key);
    report_missing(key, numbers_text(3, range));
    return std::nullopt;
  }
  const auto numbers = numbers_if_any(key, 3, range);
  if (!numbers) return std::nullopt;
  return Vec3((*numbers)[0], (*numbers)[1], (*numbers)[2]);
}

Vec3 Fields::point_or(std::string_view key, const Vec3& otherwise) {
  if (has(key)) return point(key).value_or(otherwise);
  asked_.emplace_back(key);
  return otherwise;
}

std::vector<std::vector<double>> Fields::rows(std::string_view key, std::size_t columns,
                                              std::size_t least, Range range) {
  const toml::node* node = find(key);
  const std::string expected = concat("an array of at least ", std::to_string(least),
                                      " rows, each ", numbers_text(columns, range));
  if (node == nullptr) {
    report_missing(key, expected);
    return {};
  }
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() < least) {
    expect(key, *node, expected);
    return {};
  }
  std::vector<std::vector<double>> rows;
  bool good = true;
  for (const toml::node& element : *array) {
    auto numbers = as_numbers(element, columns, range);
    if (!numbers) {
      expect(key, element, "a row: " + numbers_text(columns, range));
      good = false;
    } else {
      rows.push_back(std::move(*numbers));
    }
  }
  if (!good) rows.clear();
  return rows;
}

int Fields::whole_number_or(std::string_view key, int low, int high, int otherwise) {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  const auto value = node->is_integer() ? node->value<std::int64_t>() : std::nullopt;
  if (value && *value >= low && *value <= high) return static_cast<int>(*value);
  expect(key, *node, concat("a whole number ", std::to_string(low), " … ", std::to_string(high)));
  return otherwise;
}

bool Fields::flag_or(std::string_view key, bool otherwise) {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  if (const auto* flag = node->as_boolean()) return flag->get();
  expect(key, *node, "true or false");
  return otherwise;
}

std::optional<std::string> Fields::text(std::string_view key, std::string_view expected) {
  const toml::node* node = find(key);
  if (node == nullptr) {
    report_missing(key, expected);
    return std::nullopt;
  }
  const auto* text = node->as_string();
  if (text != nullptr && !text->get().empty()) return text->get();
  expect(key, *node, expected);
  return std::nullopt;
}

std::string Fields::text_or(std::string_view key, std::string otherwise) {
  if (has(key)) return text(key, "a text").value_or(otherwise);
  asked_.emplace_back(key);
  return otherwise;
}

std::vector<std::string> Fields::texts_if_any(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  const toml::array* array = node->as_array();
  if (array == nullptr || !array->is_homogeneous(toml::node_type::string)) {
    expect(key, *node, "an array of texts");
    return {};
  }
  std::vector<std::string> texts;
  for (const toml::node& element : *array) texts.push_back(element.as_string()->get());
  return texts;
}

Duration Fields::seconds_or(std::string_view key, double otherwise) {
  return std::chrono::duration_cast<Duration>(
      std::chrono::duration<double>(number_or(key, kSecondsRange, otherwise)));
}

std::vector<Fields> Fields::tables(std::string_view key) {
  const toml::node* node = find(key);
  std::vector<Fields> tables;
  if (node == nullptr) return tables;
  const toml::array* array = node->as_array();
  if (array == nullptr || !array->is_array_of_tables()) {
    expect(key, *node, concat("tables, [[", full(key), "]]"));
    return tables;
  }
  for (const toml::node& each : *array)
    tables.emplace_back(*each.as_table(), full(key), *problems_);
  return tables;
}

std::optional<Fields> Fields::table(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (const toml::table* table = node->as_table()) return Fields(*table, full(key), *problems_);
  expect(key, *node, concat("a table, [", full(key), "]"));
  return std::nullopt;
}

std::vector<std::pair<std::string, Fields>> Fields::named_tables() {
  std::vector<std::pair<std::string, Fields>> tables;
  for (const auto& [key, node] : *table_) {
    if (auto fields = table(key.str())) tables.emplace_back(std::string(key.str()), *fields);
  }
  return tables;
}

void Fields::finish() {
  const std::vector<std::string_view> known(asked_.begin(), asked_.end());
  for (const auto& [key, node] : *table_) {
    if (std::ranges::find(known, key.str()) != known.end()) continue;
    problems_->report(key.source().begin.line, full(printable(key.str())),
                      "unknown key" + config::suggest(key.str(), known));
  }
}

}  // namespace convexcut::simulation
