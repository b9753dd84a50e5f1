// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/file_kind.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>

namespace convexcut::recording {
namespace {

// The first four bytes as they lie in the file: pcap with microseconds and with nanoseconds, in
// either byte order, and pcapng's section header.
constexpr std::array<std::array<unsigned char, 4>, 5> kMagics{{{0xA1, 0xB2, 0xC3, 0xD4},
                                                               {0xD4, 0xC3, 0xB2, 0xA1},
                                                               {0xA1, 0xB2, 0x3C, 0x4D},
                                                               {0x4D, 0x3C, 0xB2, 0xA1},
                                                               {0x0A, 0x0D, 0x0D, 0x0A}}};

}  // namespace

bool is_capture(const std::filesystem::path& file) {
  std::array<char, 4> first{};
  std::ifstream in(file, std::ios::binary);
  if (!in.read(first.data(), first.size())) return false;
  return std::any_of(kMagics.begin(), kMagics.end(), [&first](const auto& magic) {
    return std::equal(magic.begin(), magic.end(), first.begin(),
                      [](unsigned char m, char c) { return m == static_cast<unsigned char>(c); });
  });
}

std::unique_ptr<capture::CaptureReader> open_capture(const std::filesystem::path& file,
                                                     capture::LinkKind link,
                                                     std::string_view expected) {
  if (!is_capture(file)) return nullptr;
  auto reader = std::make_unique<capture::CaptureReader>(file);
  if (reader->link() != link) {
    throw capture::CaptureError(file.string() + ": expected " + std::string(expected) +
                                ", found a capture of another kind");
  }
  return reader;
}

std::uint64_t size_of(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  return error ? 0 : size;
}

}  // namespace convexcut::recording
