// SPDX-License-Identifier: Apache-2.0
//
// Values as text for files and messages. Control characters never get through, so that a message
// stays one line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "config/schema.hpp"

namespace convexcut::config {

template <class... Parts>
[[nodiscard]] std::string concat(const Parts&... parts) {
  std::string text;
  (text.append(std::string_view(parts)), ...);
  return text;
}

[[nodiscard]] std::string integer_text(std::int64_t value, Integer::Notation notation);

// The shortest decimal that reads back as the same double: "0.5", "100", "1e-06", "nan".
[[nodiscard]] std::string number_text(double value);

// Control characters become TOML escapes; what is longer than `limit` bytes is cut, with "…".
[[nodiscard]] std::string printable(std::string_view text,
                                    std::size_t limit = std::numeric_limits<std::size_t>::max());

// A TOML basic string.
[[nodiscard]] std::string toml_string(std::string_view text);

}  // namespace convexcut::config
