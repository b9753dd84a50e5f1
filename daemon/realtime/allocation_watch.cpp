// SPDX-License-Identifier: Apache-2.0
#include "daemon/realtime/allocation_watch.hpp"

#include <cstdlib>

namespace convexcut::daemon {
namespace {

constinit thread_local Counter* watching = nullptr;

}  // namespace

void watch_allocations(Counter* calls) noexcept { watching = calls; }

void note_allocation() noexcept {
  if (watching != nullptr) watching->add();
}

bool allocations_are_heard() noexcept {
  Counter calls;
  Counter* const before = watching;
  watching = &calls;
  void* volatile probe = std::malloc(1);  // NOLINT(cppcoreguidelines-no-malloc): what is tried
  std::free(probe);                       // NOLINT(cppcoreguidelines-no-malloc)
  watching = before;
  return calls.value() == 2;
}

}  // namespace convexcut::daemon
