// SPDX-License-Identifier: Apache-2.0
#include "daemon/metrics/metrics_server.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

namespace convexcut::daemon {
namespace {

// Clients that wait for their turn; more are refused by the kernel.
constexpr int kBacklog = 8;

std::string response(std::string_view status, std::string_view content_type, std::string_view body,
                     std::string_view more_headers = "") {
  std::string text = "HTTP/1.0 " + std::string(status) + "\r\n";
  text.append("Content-Type: ").append(content_type).append("\r\n");
  text.append("Content-Length: ").append(std::to_string(body.size())).append("\r\n");
  text.append(more_headers).append("Connection: close\r\n\r\n").append(body);
  return text;
}

std::string plain(std::string_view status, std::string_view more_headers = "") {
  return response(status, "text/plain", std::string(status) + "\n", more_headers);
}

bool is_whole(std::string_view request) {
  return request.find("\r\n\r\n") != std::string_view::npos ||
         request.find("\n\n") != std::string_view::npos;
}

// "GET /metrics HTTP/1.1" → {"GET", "/metrics"}, without a query; empty when it is no request.
std::pair<std::string_view, std::string_view> method_and_path(std::string_view request) {
  const std::string_view line = request.substr(0, request.find_first_of("\r\n"));
  const std::size_t first = line.find(' ');
  const std::size_t second = first == std::string_view::npos ? first : line.find(' ', first + 1);
  if (second == std::string_view::npos || !line.substr(second + 1).starts_with("HTTP/")) return {};
  const std::string_view target = line.substr(first + 1, second - first - 1);
  return {line.substr(0, first), target.substr(0, target.find('?'))};
}

}  // namespace

MetricsServer::MetricsServer(MetricsServerOptions options, std::string_view content_type)
    : options_(std::move(options)),
      content_type_(content_type),
      listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)),
      stop_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  listen();
  thread_ = std::thread([this] { run(); });
  static_cast<void>(::pthread_setname_np(thread_.native_handle(), "metrics"));
}

MetricsServer::~MetricsServer() {
  ::eventfd_write(stop_.get(), 1);
  thread_.join();
}

void MetricsServer::listen() {
  const auto fail = [this](const std::string& reason) {
    throw MetricsError("metrics.address, metrics.port: cannot serve metrics on " +
                       options_.address + ":" + std::to_string(options_.port) + ": " + reason);
  };
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(options_.port);
  if (::inet_pton(AF_INET, options_.address.c_str(), &address.sin_addr) != 1) {
    fail("expected an IPv4 address");
  }
  // A daemon that is restarted is not kept out by connections of the one before.
  const int yes = 1;
  ::setsockopt(listener_.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listener_.get(), kBacklog) != 0) {
    const int error = errno;
    fail(std::string(std::strerror(error)) +
         (error == EADDRINUSE ? ": another program has the port, choose another one" : ""));
  }
  socklen_t size = sizeof address;
  ::getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&address), &size);
  port_ = ntohs(address.sin_port);
}

void MetricsServer::show(std::string text) {
  const std::lock_guard lock(mutex_);
  text_ = std::move(text);
}

void MetricsServer::run() noexcept {
  while (wait(listener_.get(), POLLIN, Deadline::max())) {
    const live::FileDescriptor client(
        ::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!client) {
      // Out of descriptors, most likely: not to spin until there are some again.
      if (errno != EAGAIN && errno != ECONNABORTED && errno != EINTR) ::usleep(100'000);
      continue;
    }
    try {
      serve(client.get());
    } catch (const std::exception&) {
      refused_.add();  // out of memory: this client is not answered
    }
  }
}

void MetricsServer::serve(int client) {
  const Deadline deadline = std::chrono::steady_clock::now() + options_.client_patience;
  const std::string request = read_request(client, deadline);
  if (request.empty()) {
    refused_.add();  // gone, or silent
    return;
  }
  send(client, answer_to(request), deadline);
  // What the client still sends is read for a moment: closing before would reset the connection and
  // could take our answer away from it.
  ::shutdown(client, SHUT_WR);
  std::array<char, 512> rest;
  std::size_t left = kMaxRequest;
  while (left > 0 && wait(client, POLLIN, deadline)) {
    const ssize_t got = ::recv(client, rest.data(), rest.size(), 0);
    if (got <= 0) return;
    left -= std::min(left, static_cast<std::size_t>(got));
  }
}

bool MetricsServer::wait(int fd, short events, Deadline deadline) const noexcept {
  for (;;) {
    int timeout_ms = -1;
    if (deadline != Deadline::max()) {
      const auto left =
          std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
      if (left.count() <= 0) return false;
      timeout_ms = static_cast<int>(left.count());
    }
    std::array<pollfd, 2> polls{{{stop_.get(), POLLIN, 0}, {fd, events, 0}}};
    const int ready = ::poll(polls.data(), polls.size(), timeout_ms);
    if (ready < 0 && errno != EINTR) return false;
    if (polls[0].revents != 0) return false;
    if (ready > 0) return (polls[1].revents & events) != 0;
  }
}

// Up to the end of the headers, or kMaxRequest bytes; empty when that does not come in time.
std::string MetricsServer::read_request(int client, Deadline deadline) const {
  std::string request;
  std::array<char, 1024> piece;
  while (!is_whole(request) && request.size() < kMaxRequest) {
    if (!wait(client, POLLIN, deadline)) return {};
    const ssize_t got = ::recv(client, piece.data(), piece.size(), 0);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (got <= 0) return {};
    request.append(piece.data(), static_cast<std::size_t>(got));
  }
  return request;
}

void MetricsServer::send(int client, std::string_view answer, Deadline deadline) const noexcept {
  while (!answer.empty() && wait(client, POLLOUT, deadline)) {
    const ssize_t sent = ::send(client, answer.data(), answer.size(), MSG_NOSIGNAL);
    if (sent < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (sent <= 0) return;
    answer.remove_prefix(static_cast<std::size_t>(sent));
  }
}

std::string MetricsServer::answer_to(std::string_view request) {
  const auto refuse = [this](std::string_view status, std::string_view headers = "") {
    refused_.add();
    return plain(status, headers);
  };
  const auto [method, path] = method_and_path(request);
  if (method.empty()) return refuse("400 Bad Request");
  if (!is_whole(request)) return refuse("431 Request Header Fields Too Large");
  if (method != "GET") return refuse("405 Method Not Allowed", "Allow: GET\r\n");
  if (path != "/metrics") return refuse("404 Not Found");
  const std::lock_guard lock(mutex_);
  if (text_.empty()) return refuse("503 Service Unavailable");
  served_.add();
  return response("200 OK", content_type_, text_);
}

}  // namespace convexcut::daemon
