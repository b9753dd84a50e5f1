// SPDX-License-Identifier: Apache-2.0
#include "tests/support/network_namespace.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

namespace convexcut::test {
namespace {

constexpr int kPassed = 0;
constexpr int kFailed = 1;
constexpr int kNotAllowed = 77;

bool enter_namespace() {
  const uid_t user = ::getuid();
  const gid_t group = ::getgid();
  if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;
  std::ofstream("/proc/self/setgroups") << "deny";
  std::ofstream("/proc/self/uid_map") << "0 " << user << " 1\n";
  std::ofstream("/proc/self/gid_map") << "0 " << group << " 1\n";
  return std::system("ip link show lo >/dev/null") == 0;
}

}  // namespace

void in_network_namespace(const std::function<void()>& body) {
  std::fflush(nullptr);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0) << std::strerror(errno);
  if (child == 0) {
    if (!enter_namespace()) ::_exit(kNotAllowed);
    body();
    std::fflush(nullptr);
    ::_exit(::testing::Test::HasFailure() ? kFailed : kPassed);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNotAllowed) {
    GTEST_SKIP() << "needs user and network namespaces and ip(8), which are not to be had here";
  }
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == kPassed)
      << "in the network namespace: wait status " << status;
}

void ip(const std::string& arguments) {
  EXPECT_EQ(std::system(("ip " + arguments).c_str()), 0) << "ip " << arguments;
}

void set_ipv4(const std::string& interface, const std::string& key, int value) {
  std::ofstream file("/proc/sys/net/ipv4/conf/" + interface + "/" + key);
  file << value << std::flush;
  EXPECT_TRUE(file.good()) << interface << " " << key;
}

}  // namespace convexcut::test
