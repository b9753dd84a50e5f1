// SPDX-License-Identifier: Apache-2.0
//
// Cyclone DDS's settings for our domain, as XML text. They never come from CYCLONEDDS_URI, which
// belongs to the user's other DDS and ROS 2 programs.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace convexcut::daemon {

// Participants of one host that find each other without multicast; as ROS 2 sets it (Jazzy,
// discovery range LOCALHOST).
inline constexpr std::uint32_t kMaxParticipantIndex = 32;

// For `dds.profile = ""`; docs/design/dds.md has the reasons.
[[nodiscard]] std::string_view builtin_profile() noexcept;

// The built-in profile when path is empty, else the file's content. DdsError when it cannot be
// read or is not XML.
[[nodiscard]] std::string load_profile(const std::string& path);

}  // namespace convexcut::daemon
