// SPDX-License-Identifier: Apache-2.0
#include "tests/support/network_namespace.hpp"

#include <cstdlib>
#include <fstream>

#include <sched.h>
#include <unistd.h>

#include "tests/support/in_child.hpp"

namespace convexcut::test {
namespace {

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
  in_child(enter_namespace,
           "needs user and network namespaces and ip(8), which are not to be had here", body);
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
