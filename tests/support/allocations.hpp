// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace convexcut::test {

// Calls of the global operator new since the start of the program, of all threads. A program that
// links convexcut_allocation_counter has its operator new replaced by one that counts. It does not
// see memory that is taken from malloc() or mapped by other means.
[[nodiscard]] std::uint64_t allocations() noexcept;

}  // namespace convexcut::test
