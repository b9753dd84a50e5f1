// SPDX-License-Identifier: Apache-2.0
#include "config/draft.hpp"

#include <optional>
#include <utility>

#include "config/conflicts.hpp"
#include "config/loader.hpp"
#include "config/value_text.hpp"

namespace convexcut::config {
namespace {

constexpr std::size_t kShownBytes = 60;

std::string shown(const Found& found) {
  if (!found.other.empty()) return std::string(found.other);
  const auto* text = std::get_if<std::string>(&found.value);
  return text != nullptr ? concat("\"", printable(*text, kShownBytes), "\"")
                         : to_toml(found.value, Boolean{});
}

}  // namespace

void Draft::assign(const Key& key, const Found& found, std::string place) {
  std::optional<Value> accepted;
  if (found.other.empty()) accepted = accept(key.domain, found.value);
  if (accepted) {
    key.set(config_, *accepted);
  } else {
    report(place, "expected " + expected(key.domain) + ", found " + shown(found));
  }
  sources_[key.name] = {++assignments_, std::move(place), !accepted};
}

void Draft::report(std::string_view place, std::string_view message) {
  errors_.push_back(std::string(place) + ": " + std::string(message));
}

void Draft::report_conflicts() {
  for (const Conflict& conflict : find_conflicts(config_)) {
    // The defaults do not conflict, so one of the keys was assigned; the last one is to blame.
    const Source* blamed = nullptr;
    bool wrong = false;
    for (const std::string_view key : conflict.keys) {
      const auto found = sources_.find(key);
      if (found == sources_.end()) continue;
      wrong = wrong || found->second.wrong;
      if (blamed == nullptr || found->second.order > blamed->order) blamed = &found->second;
    }
    // With a value that was refused, the conflict is with a default that nobody asked for.
    if (blamed != nullptr && !wrong) report(blamed->place, conflict.text);
  }
}

Config Draft::finish() {
  if (complete_) report_conflicts();
  if (errors_.empty()) return config_;
  std::string all;
  for (const std::string& error : errors_) {
    if (!all.empty()) all += '\n';
    all += error;
  }
  throw ConfigError(all);
}

}  // namespace convexcut::config
