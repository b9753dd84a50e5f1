// SPDX-License-Identifier: Apache-2.0
#include "daemon/dds/profile.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "daemon/dds/entity.hpp"

namespace convexcut::daemon {
namespace {

// ParticipantIndex auto with localhost as a peer: programs of one host find each other over unicast
// where multicast does not work (no network at all, containers, firewalls), besides the multicast
// discovery of everyone else.
// MaxMessageSize and SocketReceiveBufferSize: a scan is 1.7 MB in one burst.
constexpr std::string_view kBuiltin = R"(<CycloneDDS>
  <Domain id="any">
    <General>
      <MaxMessageSize>65500B</MaxMessageSize>
    </General>
    <Discovery>
      <ParticipantIndex>auto</ParticipantIndex>
      <MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
      <Peers><Peer Address="localhost"/></Peers>
    </Discovery>
    <Internal>
      <SocketReceiveBufferSize min="default" max="8MiB"/>
    </Internal>
  </Domain>
</CycloneDDS>
)";
static_assert(kMaxParticipantIndex == 32, "as written above");

}  // namespace

std::string_view builtin_profile() noexcept { return kBuiltin; }

std::string load_profile(const std::string& path) {
  if (path.empty()) return std::string(kBuiltin);
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  if (file.is_open()) content << file.rdbuf();
  if (!file.is_open() || content.bad()) {
    throw DdsError("dds.profile: cannot read " + path + ": " + std::strerror(errno));
  }
  std::string text = std::move(content).str();
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  if (start == std::string::npos || text[start] != '<') {
    throw DdsError("dds.profile: " + path + " is not a Cyclone DDS XML file");
  }
  return text;
}

}  // namespace convexcut::daemon
