// SPDX-License-Identifier: Apache-2.0
#include "daemon/dds/domain.hpp"

#include <map>
#include <mutex>
#include <string_view>

#include "daemon/dds/cyclone_log.hpp"

namespace convexcut::daemon {
namespace {

std::string described(std::uint32_t number) { return "DDS domain " + std::to_string(number); }

// Cyclone takes any text for the value of CYCLONEDDS_URI and says so; ours is not.
std::string without_uri_name(std::string message) {
  constexpr std::string_view kUriName = "CYCLONEDDS_URI+0 ";
  const std::size_t at = message.find(kUriName);
  if (at != std::string::npos) message.erase(at, kUriName.size());
  return message;
}

}  // namespace

Domain::Domain(std::uint32_t number, const std::string& profile_path)
    : number_(number), profile_path_(profile_path) {
  const std::string profile = load_profile(profile_path);
  route_cyclone_log();
  const CycloneLogCapture capture;
  const dds_entity_t handle = dds_create_domain(number, profile.c_str());
  if (handle < 0) {
    const std::string source = profile_path.empty() ? "" : "dds.profile " + profile_path + ": ";
    throw DdsError(
        described(number) + ": " + source +
        (capture.first().empty() ? dds_strretcode(handle) : without_uri_name(capture.first())));
  }
  entity_ = Entity(handle);
}

std::shared_ptr<Domain> Domain::open(std::uint32_t number, const std::string& profile_path) {
  if (number > kMaxDomain) {
    throw DdsError("dds.domain: " + std::to_string(number) + " is not a DDS domain, expected 0 … " +
                   std::to_string(kMaxDomain));
  }
  static std::mutex mutex;
  static std::map<std::uint32_t, std::weak_ptr<Domain>> open_domains;
  const std::lock_guard lock(mutex);
  if (std::shared_ptr<Domain> domain = open_domains[number].lock()) {
    if (domain->profile_path_ != profile_path) {
      throw DdsError(described(number) + " is already open with another profile");
    }
    return domain;
  }
  std::shared_ptr<Domain> domain(new Domain(number, profile_path));
  open_domains[number] = domain;
  return domain;
}

}  // namespace convexcut::daemon
