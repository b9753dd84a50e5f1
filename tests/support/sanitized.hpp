// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace convexcut::test {

// Whether this build has a sanitizer: its memory is the sanitizer's, and its speed is not the
// product's.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace convexcut::test
