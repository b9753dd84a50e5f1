// SPDX-License-Identifier: Apache-2.0
#include "daemon/dds/entity.hpp"

#include <string>

namespace convexcut::daemon {

Entity require(dds_entity_t handle, std::string_view what) {
  if (handle < 0) throw DdsError(std::string(what) + ": " + dds_strretcode(handle));
  return Entity(handle);
}

}  // namespace convexcut::daemon
