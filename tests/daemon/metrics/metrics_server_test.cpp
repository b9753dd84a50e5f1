// SPDX-License-Identifier: Apache-2.0
//
// Over real connections on loopback. Does not prove that a Prometheus server is content, only that
// the format's grammar is kept.
#include "daemon/metrics/metrics_server.hpp"

#include <atomic>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/health/prometheus.hpp"
#include "tests/daemon/health/exposition_checker.hpp"
#include "tests/daemon/health/made_up_snapshot.hpp"
#include "tests/support/tcp_client.hpp"

namespace convexcut::daemon {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;
using ::testing::StartsWith;

using Client = test::TcpClient;

std::string ask(const MetricsServer& server, const std::string& request) {
  const Client client(server.port());
  client.send(request);
  return client.receive();
}
std::string body_of(const std::string& answer) {
  const std::size_t end = answer.find("\r\n\r\n");
  return end == std::string::npos ? "" : answer.substr(end + 4);
}

MetricsServerOptions patient(Duration patience) {
  MetricsServerOptions options;
  options.client_patience = patience;
  return options;
}

class Metrics : public ::testing::Test {
 protected:
  Metrics() { server_.show("first 1\n"); }
  MetricsServer server_{patient(std::chrono::seconds{20}), kPrometheusContentType};
};

TEST_F(Metrics, ServesWhatIsShownNow) {
  const std::string answer = ask(server_, "GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(answer, StartsWith("HTTP/1.0 200 OK\r\n"));
  EXPECT_THAT(answer, HasSubstr("Content-Type: text/plain; version=0.0.4; charset=utf-8\r\n"));
  EXPECT_THAT(answer, HasSubstr("Content-Length: 8\r\n"));
  EXPECT_EQ(body_of(answer), "first 1\n");
  server_.show("second 2\n");
  EXPECT_EQ(body_of(ask(server_, "GET /metrics HTTP/1.0\r\n\r\n")), "second 2\n");
  EXPECT_EQ(server_.served(), 2U);
}

TEST_F(Metrics, ServesAWholeSnapshotInPrometheusFormat) {
  server_.show(prometheus_text(testing::made_up_snapshot()));
  const std::string answer = ask(server_, "GET /metrics HTTP/1.1\r\n\r\n");
  EXPECT_EQ(testing::read_exposition(body_of(answer)).at("convexcut_results_total"), "900");
}

TEST_F(Metrics, TakesARequestInPieces) {
  const Client client(server_.port());
  for (const char* const piece : {"GE", "T /metri", "cs HTTP/1.1\r\nHost: a\r\n", "\r", "\n"}) {
    client.send(piece);
    std::this_thread::sleep_for(milliseconds{5});
  }
  EXPECT_EQ(body_of(client.receive()), "first 1\n");
}

TEST_F(Metrics, AQueryIsIgnored) {
  EXPECT_EQ(body_of(ask(server_, "GET /metrics?x=1 HTTP/1.1\r\n\r\n")), "first 1\n");
}

TEST_F(Metrics, RefusesWhatItDoesNotServe) {
  EXPECT_THAT(ask(server_, "GET / HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.0 404 "));
  EXPECT_THAT(ask(server_, "GET /metrics/../etc/passwd HTTP/1.1\r\n\r\n"),
              StartsWith("HTTP/1.0 404 "));
  EXPECT_THAT(ask(server_, "POST /metrics HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.0 405 "));
  EXPECT_EQ(server_.refused(), 3U);
  EXPECT_EQ(server_.served(), 0U);
}

TEST_F(Metrics, RefusesGarbage) {
  EXPECT_THAT(ask(server_, "\r\n\r\n"), StartsWith("HTTP/1.0 400 "));
  EXPECT_THAT(ask(server_, "GET\r\n\r\n"), StartsWith("HTTP/1.0 400 "));
  EXPECT_THAT(ask(server_, "GET /metrics\r\n\r\n"), StartsWith("HTTP/1.0 400 "));
  EXPECT_THAT(
      ask(server_, std::string("\x16\x03\x01\x00\xff", 5) + std::string(500, '\0') + "\r\n\r\n"),
      StartsWith("HTTP/1.0 400 "));
  EXPECT_EQ(body_of(ask(server_, "GET /metrics HTTP/1.1\r\n\r\n")), "first 1\n");
}

TEST_F(Metrics, RefusesARequestThatDoesNotEnd) {
  const Client client(server_.port());
  client.send("GET /metrics HTTP/1.1\r\n");
  client.send("X: " + std::string(MetricsServer::kMaxRequest, 'x'));
  EXPECT_THAT(client.receive(), StartsWith("HTTP/1.0 431 "));
}

TEST(MetricsServer, BeforeAnythingIsShownSaysSo) {
  MetricsServer server({}, "text/plain");
  EXPECT_THAT(ask(server, "GET /metrics HTTP/1.0\r\n\r\n"), StartsWith("HTTP/1.0 503 "));
}

TEST(MetricsServer, ASilentClientIsLeftAndTheNextIsServed) {
  MetricsServer server(patient(milliseconds{50}), "text/plain");
  server.show("text\n");
  const Client silent(server.port());
  const Client half(server.port());
  half.send("GET /metr");
  EXPECT_EQ(body_of(ask(server, "GET /metrics HTTP/1.0\r\n\r\n")), "text\n");
  EXPECT_EQ(silent.receive(), "");
  EXPECT_EQ(half.receive(), "");
  EXPECT_EQ(server.refused(), 2U);
}

TEST(MetricsServer, AClientThatDoesNotTakeItsAnswerIsLeft) {
  MetricsServer server(patient(milliseconds{50}), "text/plain");
  server.show(std::string(32U << 20U, 'x'));  // more than the sockets' buffers take
  const Client stubborn(server.port());
  stubborn.send("GET /metrics HTTP/1.0\r\n\r\n");
  while (server.served() == 0) std::this_thread::yield();
  server.show("text\n");
  EXPECT_EQ(body_of(ask(server, "GET /metrics HTTP/1.0\r\n\r\n")), "text\n");
}

TEST(MetricsServer, EndsAtOnceWithAClientHangingOn) {
  const auto begin = std::chrono::steady_clock::now();
  {
    MetricsServer server(patient(std::chrono::hours{1}), "text/plain");
    const Client silent(server.port());
    silent.send("GET");
    std::this_thread::sleep_for(milliseconds{20});
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::minutes{1});
}

TEST(MetricsServer, ManyClientsAtOnceAreServedOneAfterTheOther) {
  MetricsServer server({}, "text/plain");
  server.show("text\n");
  std::atomic<int> good{0};
  std::vector<std::thread> clients;
  for (int i = 0; i < 8; ++i) {
    clients.emplace_back([&] {
      for (int n = 0; n < 20; ++n) {
        if (body_of(ask(server, "GET /metrics HTTP/1.0\r\n\r\n")) == "text\n") ++good;
      }
    });
  }
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(good, 160);
}

std::string error_of(const MetricsServerOptions& options) {
  try {
    const MetricsServer server(options, "text/plain");
  } catch (const MetricsError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(MetricsServer, APortInUseIsOneClearLine) {
  const MetricsServer server({}, "text/plain");
  MetricsServerOptions same;
  same.port = server.port();
  EXPECT_EQ(error_of(same), "metrics.address, metrics.port: cannot serve metrics on 127.0.0.1:" +
                                std::to_string(server.port()) +
                                ": Address already in use: another program has the port, choose "
                                "another one");
}

TEST(MetricsServer, AnAddressThatIsNotTheHostsIsOneClearLine) {
  MetricsServerOptions foreign;
  foreign.address = "192.0.2.1";
  EXPECT_THAT(error_of(foreign), HasSubstr("on 192.0.2.1:0: Cannot assign requested address"));
}

}  // namespace
}  // namespace convexcut::daemon
