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
  ProfileFile(std::string_view name, std::string_view text)
      : path_(std::filesystem::temp_directory_path() /
              ("convexcut-" + std::to_string(::getpid()) + "-" + std::string(name) + ".xml")) {
    std::ofstream(path_) << text;
  }
  ~ProfileFile() { std::filesystem::remove(path_); }
  ProfileFile(const ProfileFile&) = delete;
  ProfileFile& operator=(const ProfileFile&) = delete;
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

// Spread over the domains whose ports lie below the ephemeral range (0 … 100), in pairs.
std::uint32_t first_domain() { return 2 * (static_cast<std::uint32_t>(::getpid()) % 50); }

}  // namespace

config::Dds test_settings() {
  static const ProfileFile file("loopback", loopback_profile());
  config::Dds settings;
  settings.domain = first_domain();
  settings.profile = file.path();
  return settings;
}

config::Dds test_settings_with_whc_high(std::string_view size) {
  std::string profile = loopback_profile();
  replace(profile, "<WhcHigh>8MiB</WhcHigh>", "<WhcHigh>" + std::string(size) + "</WhcHigh>");
  static const ProfileFile file("whc", profile);
  config::Dds settings;
  settings.domain = first_domain() + 1;
  settings.profile = file.path();
  return settings;
}

}  // namespace convexcut::daemon::testing
