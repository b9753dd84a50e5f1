// SPDX-License-Identifier: Apache-2.0
//
// What Cyclone DDS has to say goes to our log instead of raw to stderr; while a domain is being
// opened, its complaints are collected for the error message.
#pragma once

#include <string>

namespace convexcut::daemon {

// Sends Cyclone's warnings and errors of all threads to the log from now on.
void route_cyclone_log();

// Collects the errors that Cyclone reports on this thread while the object lives.
class CycloneLogCapture {
 public:
  CycloneLogCapture() noexcept;
  ~CycloneLogCapture();
  CycloneLogCapture(const CycloneLogCapture&) = delete;
  CycloneLogCapture& operator=(const CycloneLogCapture&) = delete;

  // The first of them; empty when there was none.
  [[nodiscard]] const std::string& first() const noexcept { return first_; }

 private:
  std::string first_;
};

}  // namespace convexcut::daemon
