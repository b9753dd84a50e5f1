// SPDX-License-Identifier: Apache-2.0
#include "tests/support/in_child.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

namespace convexcut::test {

void in_child(const std::function<bool()>& enter, const char* reason,
              const std::function<void()>& body) {
  std::fflush(nullptr);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0) << std::strerror(errno);
  if (child == 0) {
    if (!enter()) ::_exit(kNotAllowed);
    body();
    std::fflush(nullptr);
    ::_exit(::testing::Test::HasFailure() ? 1 : 0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNotAllowed) GTEST_SKIP() << reason;
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "child: wait status " << status;
}

void without_privileges(const std::function<void()>& body) {
  constexpr uid_t kNobody = 65534;
  const auto enter = [] { return ::getuid() != 0 || ::setresuid(kNobody, kNobody, kNobody) == 0; };
  in_child(enter, "cannot become a user without privileges", body);
}

}  // namespace convexcut::test
