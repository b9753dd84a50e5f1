// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace convexcut::simulation {

// All that is wrong with a scene file, so that it can be said at once.
class Problems {
 public:
  explicit Problems(std::string file) : file_(std::move(file)) {}

  // Line 0: of the file as a whole. `key` may be empty.
  void report(std::size_t line, std::string_view key, std::string_view what);
  [[nodiscard]] bool empty() const noexcept { return problems_.empty(); }

  // Throws SceneError with a line for each problem, in the order of the file, when there are any.
  void throw_if_any() const;

 private:
  struct Problem {
    std::size_t line;
    std::string text;
  };
  std::string file_;
  std::vector<Problem> problems_;
};

}  // namespace convexcut::simulation
