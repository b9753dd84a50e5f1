// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

#include "drivers/capture/capture_reader.hpp"

namespace convexcut::recording {

// Whether the file begins as a pcap or pcapng file does. False when it cannot be read: opening it
// as something else then says why.
[[nodiscard]] bool is_capture(const std::filesystem::path& file);

// The file as a capture of this link; null when it is no capture at all. Throws
// capture::CaptureError when it is a capture of another link, saying that `expected` was.
[[nodiscard]] std::unique_ptr<capture::CaptureReader> open_capture(
    const std::filesystem::path& file, capture::LinkKind link, std::string_view expected);

// 0 when it is not a regular file.
[[nodiscard]] std::uint64_t size_of(const std::filesystem::path& file);

}  // namespace convexcut::recording
