// SPDX-License-Identifier: Apache-2.0
//
// Does not prove that lines of several processes on one terminal stay whole: one write(2) a line is
// what we can do, and what is tested.
#include "daemon/log/log.hpp"

#include <array>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <gtest/gtest.h>

namespace convexcut::daemon::log {
namespace {

using config::LogLevel;

// Stands in for stderr with a socket that keeps the borders of writes: one record, one write(2).
class StderrRecords {
 public:
  StderrRecords() : saved_(::dup(STDERR_FILENO)) {
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends_.data()) != 0) std::abort();
    ::dup2(ends_[1], STDERR_FILENO);
  }
  ~StderrRecords() {
    ::dup2(saved_, STDERR_FILENO);
    for (const int fd : {saved_, ends_[0], ends_[1]}) ::close(fd);
  }
  StderrRecords(const StderrRecords&) = delete;
  StderrRecords& operator=(const StderrRecords&) = delete;

  std::vector<std::string> take() {
    std::vector<std::string> records;
    std::array<char, 2 * kMaxLineBytes> buffer;
    ssize_t got = 0;
    while ((got = ::recv(ends_[0], buffer.data(), buffer.size(), 0)) > 0) {
      records.emplace_back(buffer.data(), static_cast<std::size_t>(got));
    }
    return records;
  }

 private:
  int saved_;
  std::array<int, 2> ends_{};
};

TEST(Log, WritesEachLineWithOneWrite) {
  StderrRecords stderr_records;
  info("started", {{"domain", 0}});
  error("failed", {{"why", "no such device"}});
  EXPECT_EQ(stderr_records.take(),
            (std::vector<std::string>{"info started domain=0\n",
                                      "error failed why=\"no such device\"\n"}));
}

TEST(Log, DropsLinesAboveTheLevel) {
  StderrRecords stderr_records;
  set_level(LogLevel::warning);
  info("dropped");
  debug("dropped");
  warning("kept");
  set_level(LogLevel::info);
  debug("dropped");
  EXPECT_EQ(stderr_records.take(), std::vector<std::string>{"warning kept\n"});
}

TEST(Log, LinesOfSeveralThreadsStayWhole) {
  StderrRecords stderr_records;
  std::vector<std::thread> threads;
  threads.reserve(4);
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([] {
      for (int i = 0; i < 20; ++i) info("tick", {{"text", "one two three"}});
    });
  }
  for (std::thread& thread : threads) thread.join();
  const auto records = stderr_records.take();
  EXPECT_EQ(records.size(), 80U);
  for (const std::string& record : records) EXPECT_EQ(record, "info tick text=\"one two three\"\n");
}

TEST(LogDestination, IsTheJournalOnlyWhenStderrIsTheStreamThatSystemdNamed) {
  struct stat actual {};
  ASSERT_EQ(::fstat(STDERR_FILENO, &actual), 0);
  const std::string ours = std::to_string(actual.st_dev) + ":" + std::to_string(actual.st_ino);
  const std::string other = std::to_string(actual.st_dev) + ":" + std::to_string(actual.st_ino + 1);
  EXPECT_EQ(stderr_destination(ours.c_str()), Destination::journal);
  EXPECT_EQ(stderr_destination(other.c_str()), Destination::plain);
  EXPECT_EQ(stderr_destination(nullptr), Destination::plain);
}

TEST(LogDestination, IsPlainWhenTheVariableIsMalformed) {
  for (const char* text : {"", ":", "1", "1:", ":2", "a:b", "1:2x"}) {
    EXPECT_EQ(stderr_destination(text), Destination::plain) << text;
  }
}

}  // namespace
}  // namespace convexcut::daemon::log
