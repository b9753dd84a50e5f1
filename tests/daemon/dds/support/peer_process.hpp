// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <sys/types.h>

#include "config/config.hpp"

namespace convexcut::daemon::testing {

// A daemon_dds_peer of our own, on our domain; ended with this object.
class PeerProcess {
 public:
  PeerProcess(const config::Dds& settings, const std::string& dds_topic);
  ~PeerProcess();
  PeerProcess(const PeerProcess&) = delete;
  PeerProcess& operator=(const PeerProcess&) = delete;

  // The next line that it prints, without its end; "" when it ended or said nothing for 20 s.
  [[nodiscard]] std::string read_line();
  void stop() const;      // as if it hung: SIGSTOP, returns when it has stopped
  void carry_on() const;  // SIGCONT

 private:
  pid_t pid_ = -1;
  int stdin_ = -1;
  int stdout_ = -1;
  std::string pending_;
};

}  // namespace convexcut::daemon::testing
