// SPDX-License-Identifier: Apache-2.0
//
// Any text as a configuration: a file up to the first zero byte, then an override. Beyond not
// crashing: what loads survives being written and loaded again, and what does not load is reported
// without control characters.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "config/loader.hpp"
#include "config/reference.hpp"
#include "config/schema.hpp"

namespace {

namespace config = convexcut::config;

void require(bool condition) {
  if (!condition) std::abort();
}

bool is_report(std::string_view text) {
  return !text.empty() &&
         std::ranges::none_of(text, [](char c) { return c >= '\0' && c < ' ' && c != '\n'; });
}

void require_same(const config::Config& a, const config::Config& b) {
  for (const config::Key& key : config::keys()) require(key.get(a) == key.get(b));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t zero = text.find('\0');
  std::vector<std::string> overrides;
  if (zero != std::string_view::npos) overrides.emplace_back(text.substr(zero + 1));
  config::Config loaded;
  try {
    loaded = config::load_text(text.substr(0, zero), "fuzz.toml", overrides);
  } catch (const config::ConfigError& error) {
    require(is_report(error.what()));
    return 0;
  }
  require_same(config::load_text(config::to_toml(loaded), "written.toml"), loaded);
  return 0;
}
