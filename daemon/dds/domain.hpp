// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "daemon/dds/entity.hpp"
#include "daemon/dds/profile.hpp"

namespace convexcut::daemon {

// The RTPS port rule (DDSI-RTPS 2.3, 9.6.1.1): base + 250·domain holds a domain's multicast ports
// and, from +10 on, two ports a participant.
inline constexpr std::uint32_t kDomainPortBase = 7400;
inline constexpr std::uint32_t kPortsPerDomain = 250;
inline constexpr std::uint32_t kMaxDomain = 232;  // above it the ports do not fit in 16 bits

// Whether a domain can use this UDP port on this host: then nothing else should (a sensor's data
// port is the case to check).
[[nodiscard]] constexpr bool domain_uses_port(std::uint32_t domain, std::uint32_t port) noexcept {
  const std::uint32_t first = kDomainPortBase + kPortsPerDomain * domain;
  const std::uint32_t last = first + 11 + 2 * kMaxParticipantIndex;
  return port >= first && port <= last;
}
static_assert(kDomainPortBase + kPortsPerDomain * kMaxDomain + 11 + 2 * kMaxParticipantIndex <=
              65535);

// A DDS domain in this process, with our settings. Participants of one domain share it: DDS has one
// set of settings a domain and process.
class Domain {
 public:
  // Opens the domain, or gives the one that is open. DdsError when the number is out of range, the
  // profile is refused, or the domain is open with another profile. Any thread.
  [[nodiscard]] static std::shared_ptr<Domain> open(std::uint32_t number,
                                                    const std::string& profile_path);

  [[nodiscard]] std::uint32_t number() const noexcept { return number_; }

 private:
  Domain(std::uint32_t number, const std::string& profile_path);

  std::uint32_t number_;
  std::string profile_path_;
  Entity entity_;
};

}  // namespace convexcut::daemon
