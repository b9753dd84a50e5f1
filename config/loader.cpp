// SPDX-License-Identifier: Apache-2.0
#include "config/loader.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <vector>

#include <system_error>

#include <toml++/toml.h>

#include "config/draft.hpp"
#include "config/schema.hpp"
#include "config/suggestion.hpp"
#include "config/value_text.hpp"

namespace convexcut::config {
namespace {

constexpr std::size_t kMaxFileSize = std::size_t{1} << 20U;

Found found_in(const toml::node& node) {
  if (const auto* text = node.as_string()) return {text->get()};
  if (const auto* integer = node.as_integer()) return {integer->get()};
  if (const auto* number = node.as_floating_point()) return {number->get()};
  if (const auto* boolean = node.as_boolean()) return {boolean->get()};
  if (node.is_table()) return {{}, "a table"};
  if (node.is_array()) return {{}, "an array"};
  return {{}, "a date or time"};
}

// One key of a file, with its place.
struct Entry {
  toml::source_index line = 0;
  std::string name;  // "section", or "section.key" inside a table
  const toml::node* node = nullptr;
};

// In the order of the file: toml++ sorts its tables by name.
std::vector<Entry> entries_of(const toml::table& root) {
  std::vector<Entry> entries;
  for (const auto& [key, node] : root) {
    const std::string name(key.str());
    const toml::table* table = node.as_table();
    const bool known = std::ranges::find(sections(), name, &Section::name) != sections().end();
    if (table == nullptr || !known) {
      entries.push_back({key.source().begin.line, name, &node});
      continue;
    }
    for (const auto& [leaf, value] : *table) {
      entries.push_back({leaf.source().begin.line, name + '.' + std::string(leaf.str()), &value});
    }
  }
  std::ranges::stable_sort(entries, {}, &Entry::line);
  return entries;
}

void take_entry(const Entry& entry, std::string_view file, Draft& draft) {
  const std::string place =
      std::string(file) + ':' + std::to_string(entry.line) + ": " + printable(entry.name);
  if (const Key* key = find_key(entry.name)) {
    draft.assign(*key, found_in(*entry.node), place);
  } else if (std::ranges::find(sections(), entry.name, &Section::name) != sections().end()) {
    draft.report(place, "expected a table, [" + entry.name + "]");
  } else if (entry.node->is_table()) {
    draft.report(place, "unknown table" + suggest_section(entry.name));
  } else {
    draft.report(place, "unknown key" + suggest_key(entry.name));
  }
}

void take_text(std::string_view text, std::string_view file, Draft& draft) {
  try {
    const toml::table root = toml::parse(text);
    for (const Entry& entry : entries_of(root)) take_entry(entry, file, draft);
  } catch (const toml::parse_error& error) {
    draft.report(std::string(file) + ':' + std::to_string(error.source().begin.line),
                 "not valid TOML: " + printable(error.description()));
    draft.mark_incomplete();
  }
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

// A value as it would stand in a file; what is none there is a text.
Found value_of_override(const Key& key, std::string_view text) {
  const bool is_text =
      std::holds_alternative<Text>(key.domain) || std::holds_alternative<Choice>(key.domain);
  const bool has_quotes = text.starts_with('"') || text.starts_with('\'');
  if (is_text && !has_quotes) return {std::string(text)};
  try {
    const toml::table root = toml::parse("value = " + std::string(text));
    if (root.size() == 1) return found_in(*root.get("value"));
  } catch (const toml::parse_error&) {
    // It is reported as the text that it is.
  }
  return {std::string(text)};
}

// What a file can hold: valid UTF-8.
bool is_toml_text(std::string_view text) {
  try {
    static_cast<void>(toml::parse("value = " + toml_string(text)));
    return true;
  } catch (const toml::parse_error&) {
    return false;
  }
}

void take_override(const std::string& override_text, Draft& draft) {
  const std::string place = "--set " + printable(override_text);
  if (!is_toml_text(override_text)) {
    draft.report(place, "expected text in UTF-8");
    return;
  }
  const std::size_t equals = override_text.find('=');
  if (equals == std::string::npos) {
    draft.report(place, "expected key=value");
    return;
  }
  const std::string_view name = trimmed(std::string_view(override_text).substr(0, equals));
  const std::string_view value = trimmed(std::string_view(override_text).substr(equals + 1));
  if (const Key* key = find_key(name)) {
    draft.assign(*key, value_of_override(*key, value), place);
  } else {
    draft.report(place, "unknown key" + suggest_key(name));
  }
}

// Nothing when the file cannot be read, which has been reported then.
std::optional<std::string> read_file(const std::filesystem::path& file, Draft& draft) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    draft.report(file.string(), "is a directory, expected a configuration file");
    return std::nullopt;
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    draft.report(file.string(), std::string("cannot open: ") + std::strerror(errno));
    return std::nullopt;
  }
  std::string text(kMaxFileSize + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad()) {
    draft.report(file.string(), std::string("cannot read: ") + std::strerror(errno));
    return std::nullopt;
  }
  if (text.size() > kMaxFileSize) {
    draft.report(file.string(), "is larger than 1 MiB, expected a configuration file");
    return std::nullopt;
  }
  return text;
}

Config finish(Draft& draft, std::span<const std::string> overrides) {
  for (const std::string& each : overrides) take_override(each, draft);
  return draft.finish();
}

}  // namespace

Config load_text(std::string_view toml, std::string_view name,
                 std::span<const std::string> overrides) {
  Draft draft;
  take_text(toml, name, draft);
  return finish(draft, overrides);
}

Config load(const std::optional<std::filesystem::path>& file,
            std::span<const std::string> overrides) {
  Draft draft;
  if (file) {
    if (const std::optional<std::string> text = read_file(*file, draft)) {
      take_text(*text, file->string(), draft);
    } else {
      draft.mark_incomplete();
    }
  }
  return finish(draft, overrides);
}

}  // namespace convexcut::config
