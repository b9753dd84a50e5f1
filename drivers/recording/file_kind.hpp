// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace convexcut::recording {

// Whether the file begins as a pcap or pcapng file does. False when it cannot be read: opening it
// as something else then says why.
[[nodiscard]] bool is_capture(const std::filesystem::path& file);

// 0 when it is not a regular file.
[[nodiscard]] std::uint64_t size_of(const std::filesystem::path& file);

}  // namespace convexcut::recording
