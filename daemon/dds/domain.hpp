// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "daemon/dds/entity.hpp"
#include "daemon/dds/profile.hpp"

namespace convexcut::daemon {

// Above it the ports do not fit in 16 bits (DDSI-RTPS 2.3, 9.6.1.1): a domain's ports start at 7400
// + 250·domain, with two a participant from the eleventh on.
inline constexpr std::uint32_t kMaxDomain = 232;
static_assert(7400 + 250 * kMaxDomain + 11 + 2 * kMaxParticipantIndex <= 65535);

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
