// SPDX-License-Identifier: Apache-2.0
//
// Ownership of Cyclone DDS's C handles.
#pragma once

#include <memory>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <dds/dds.h>

namespace convexcut::daemon {

// A DDS setting or call that failed, in one line. Thrown only while things are set up.
class DdsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// One DDS entity (domain, participant, topic, writer, reader …), deleted with this object.
class Entity {
 public:
  Entity() = default;
  explicit Entity(dds_entity_t handle) noexcept : handle_(handle) {}
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;
  ~Entity() {
    if (handle_ > 0) static_cast<void>(dds_delete(handle_));
  }

  [[nodiscard]] dds_entity_t get() const noexcept { return handle_; }

 private:
  dds_entity_t handle_ = 0;
};

// The entity that a dds_create_… call returned. DdsError "WHAT: reason" when it is an error code.
[[nodiscard]] Entity require(dds_entity_t handle, std::string_view what);

struct QosDeleter {
  void operator()(dds_qos_t* qos) const noexcept { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, QosDeleter>;

}  // namespace convexcut::daemon
