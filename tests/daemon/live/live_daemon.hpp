// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <csignal>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

#include <gtest/gtest.h>

#include "config/conflicts.hpp"
#include "tests/support/background_program.hpp"
#include "tests/support/room.hpp"
#include "tests/support/udp_sender.hpp"

namespace convexcut::test {

// A live daemon with ports and a DDS domain of its own, the sensors that `convexcut replay` plays
// to it, and what its log says.
class LiveDaemon : public RoomTest {
 protected:
  static std::uint32_t domain_number() { return static_cast<std::uint32_t>(100 + ::getpid() % 99); }
  static std::string domain() { return std::to_string(domain_number()); }
  // The domain's own ports are among those that the kernel gives away.
  static std::uint16_t free_lidar_port() {
    std::uint16_t port = free_udp_port();
    while (config::port_collision(domain_number(), port, port)) port = free_udp_port();
    return port;
  }

  void start_daemon(std::vector<std::string> settings, const ProgramLimits& limits = {}) {
    settings.insert(settings.begin(),
                    {"dds.domain=" + domain(), "lidar.data_port=" + std::to_string(data_port_),
                     "lidar.position_port=" + std::to_string(position_port_)});
    std::vector<std::string> arguments;
    for (const std::string& setting : settings) {
      arguments.insert(arguments.end(), {"--set", setting});
    }
    daemon_ = std::make_unique<BackgroundProgram>("convexcutd", arguments, limits);
    ASSERT_TRUE(daemon_->wait_for("info start")) << daemon_->err();
  }

  [[nodiscard]] std::vector<std::string> replay_of_lidar() const {
    return {"replay",
            "--lidar",
            lidar(),
            "--port",
            std::to_string(data_port_),
            "--position-port",
            std::to_string(position_port_),
            "--json"};
  }
  [[nodiscard]] static std::vector<std::string> with(std::vector<std::string> arguments,
                                                     const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  // What SIGUSR1 makes the daemon write.
  [[nodiscard]] std::string dump() const {
    const std::size_t before = daemon_->err().size();
    daemon_->send(SIGUSR1);
    for (int i = 0; i < 500; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds{10});
      std::string log = daemon_->err().substr(before);
      const std::size_t last = log.find("info health_totals ");
      if (last != std::string::npos && log.find('\n', last) != std::string::npos) return log;
    }
    ADD_FAILURE() << "no answer to SIGUSR1: " << daemon_->err();
    return {};
  }
  // Seconds until a source is in a state, by SIGUSR1; fails when it is not within `limit` seconds.
  double becomes(const std::string& source, const std::string& state, double limit) const {
    const auto start = std::chrono::steady_clock::now();
    std::string wanted = "health_source name=";
    wanted.append(source).append(" state=").append(state).append(" ");
    for (;;) {
      const std::string now = dump();
      const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
      if (now.find(wanted) != std::string::npos) return passed.count();
      if (passed.count() > limit) {
        ADD_FAILURE() << source << " is not " << state << " after " << limit << " s: " << now;
        return passed.count();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds{40});
    }
  }

  // The number behind `key=` in the last line of the log that begins with `event`.
  [[nodiscard]] static long logged(const std::string& log, const std::string& event,
                                   const std::string& key) {
    const std::size_t line = log.rfind(event + " ");
    const std::size_t at = log.find(" " + key + "=", line == std::string::npos ? log.size() : line);
    return at == std::string::npos ? -1 : std::stol(log.substr(at + key.size() + 2));
  }
  // The number of a key in one line of JSON.
  [[nodiscard]] static long counted(const std::string& json, const std::string& key) {
    const std::size_t at = json.find("\"" + key + "\":");
    return at == std::string::npos ? -1 : std::stol(json.substr(at + key.size() + 3));
  }
  [[nodiscard]] static long resident_kib(pid_t pid) {
    const std::string status = text("/proc/" + std::to_string(pid) + "/status");
    return std::stol(status.substr(status.find("VmRSS:") + 6));
  }

  std::uint16_t data_port_ = free_lidar_port();
  std::uint16_t position_port_ = free_lidar_port();
  std::unique_ptr<BackgroundProgram> daemon_;
};

}  // namespace convexcut::test
