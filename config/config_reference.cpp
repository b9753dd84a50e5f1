// SPDX-License-Identifier: Apache-2.0
//
// Prints the documents that are made from the schema:
//   convexcut-config-reference markdown > docs/configuration.md
//   convexcut-config-reference toml > config/convexcut.toml
#include <iostream>
#include <span>
#include <string_view>

#include "config/reference.hpp"

int main(int argc, char** argv) {
  const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
  const std::string_view document = arguments.size() == 2 ? arguments[1] : "";
  if (document == "markdown") {
    std::cout << convexcut::config::reference_markdown();
  } else if (document == "toml") {
    std::cout << convexcut::config::to_toml(convexcut::config::Config{});
  } else {
    std::cerr << "usage: convexcut-config-reference markdown|toml\n";
    return 2;
  }
  return std::cout.flush() ? 0 : 1;
}
