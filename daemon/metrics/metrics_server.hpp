// SPDX-License-Identifier: Apache-2.0
//
// Serves one text over HTTP: what Prometheus fetches. The least of a web server: GET /metrics,
// HTTP/1.0, one connection at a time, every wait bounded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

#include "core/counter.hpp"
#include "core/time.hpp"
#include "drivers/live/file_descriptor.hpp"

namespace convexcut::daemon {

// The address cannot be served. One line: what, why, what to do.
class MetricsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct MetricsServerOptions {
  std::string address = "127.0.0.1";  // IPv4
  std::uint16_t port = 0;             // 0: one that is free, see port()
  // For a client to send its request and to take the answer.
  Duration client_patience = std::chrono::seconds{2};
};

class MetricsServer {
 public:
  // A longer request is refused.
  static constexpr std::size_t kMaxRequest = 4096;

  // Listens at once, on a thread of its own that is not a realtime one. Throws MetricsError: the
  // port is in use, the address is not the host's, it is not permitted. `content_type`: of the
  // text.
  MetricsServer(MetricsServerOptions options, std::string_view content_type);
  // Does not wait for a client.
  ~MetricsServer();
  MetricsServer(const MetricsServer&) = delete;
  MetricsServer& operator=(const MetricsServer&) = delete;

  // What is served from now on. Until the first call: 503. Any thread, not a realtime one.
  void show(std::string text);

  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }
  // Any thread.
  [[nodiscard]] std::uint64_t served() const noexcept { return served_.value(); }
  [[nodiscard]] std::uint64_t refused() const noexcept { return refused_.value(); }

 private:
  using Deadline = std::chrono::steady_clock::time_point;

  void listen();
  void run() noexcept;
  void serve(int client);
  // False on a stop, at the deadline, or when the connection is broken.
  [[nodiscard]] bool wait(int fd, short events, Deadline deadline) const noexcept;
  [[nodiscard]] std::string read_request(int client, Deadline deadline) const;
  void send(int client, std::string_view answer, Deadline deadline) const noexcept;
  [[nodiscard]] std::string answer_to(std::string_view request);

  MetricsServerOptions options_;
  std::string content_type_;
  live::FileDescriptor listener_;
  live::FileDescriptor stop_;  // an eventfd, readable from the stop on
  std::uint16_t port_ = 0;
  std::mutex mutex_;
  std::string text_;  // under mutex_
  Counter served_;
  Counter refused_;
  std::thread thread_;
};

}  // namespace convexcut::daemon
