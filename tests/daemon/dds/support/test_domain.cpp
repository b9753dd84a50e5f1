// SPDX-License-Identifier: Apache-2.0
#include "support/test_domain.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <unistd.h>

#include "daemon/dds/profile.hpp"

namespace convexcut::daemon::testing {
namespace {

void replace(std::string& text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) {
    throw std::logic_error("the built-in profile has no " + std::string(from));
  }
  text.replace(at, from.size(), to);
}

std::string loopback_profile() {
  std::string profile(builtin_profile());
  replace(profile, "<General>",
          "<General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces>"
          "<AllowMulticast>false</AllowMulticast>");
  replace(profile, "<Discovery>",
          "<Discovery><Tag>convexcut-test-" + std::to_string(::getpid()) + "</Tag>");
  return profile;
}

// A file that goes with the process.
class ProfileFile {
 public:
  explicit ProfileFile(std::string_view text)
      : path_(std::filesystem::temp_directory_path() /
              ("convexcut-loopback-" + std::to_string(::getpid()) + ".xml")) {
    std::ofstream(path_) << text;
  }
  ~ProfileFile() { std::filesystem::remove(path_); }
  ProfileFile(const ProfileFile&) = delete;
  ProfileFile& operator=(const ProfileFile&) = delete;
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace

config::Dds test_settings() {
  static const ProfileFile file(loopback_profile());
  config::Dds settings;
  // Of the domains whose ports lie below the ephemeral range.
  settings.domain = static_cast<std::uint32_t>(::getpid()) % 101;
  settings.profile = file.path();
  return settings;
}

}  // namespace convexcut::daemon::testing
