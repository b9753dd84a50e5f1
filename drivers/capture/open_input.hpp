// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>

namespace convexcut::capture {

// Opens a file for reading; the caller closes it. Throws CaptureError when it is missing, not
// readable or a directory; `expected` completes the message ("a capture file").
[[nodiscard]] std::FILE* open_input(const std::filesystem::path& file, const char* expected);

// In bytes; 0 when the stream is not one to seek in.
[[nodiscard]] std::uint64_t size_of(std::FILE* stream) noexcept;

}  // namespace convexcut::capture
