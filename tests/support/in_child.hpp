// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace convexcut::test {

// Exit status of a child for "this system does not let me".
inline constexpr int kNotAllowed = 77;

// Runs `body` in a child process, to whose identity and surroundings it may do what it likes. The
// child's failures are printed and fail the calling test; when `enter` says no, the test is skipped
// with `reason`. Only from a process with one thread.
void in_child(const std::function<bool()>& enter, const char* reason,
              const std::function<void()>& body);

// in_child() as a user without privileges.
void without_privileges(const std::function<void()>& body);

}  // namespace convexcut::test
