// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/counter.hpp"

namespace convexcut::daemon {

// Counts, from now on, this thread's calls of the allocator (malloc, free and their relatives, and
// with them new and delete) in `calls`; null: no longer. Only programs that link
// convexcut_allocation_hook are heard.
void watch_allocations(Counter* calls) noexcept;

// Called by the hook, before each allocation and release.
void note_allocation() noexcept;

// Whether this program's allocations are heard: it has the hook, and no sanitizer has its own.
[[nodiscard]] bool allocations_are_heard() noexcept;

}  // namespace convexcut::daemon
