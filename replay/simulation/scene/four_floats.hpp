// SPDX-License-Identifier: Apache-2.0
//
// Four floats at once: what every processor has registers for. The compilers make one instruction
// of each operation on these.
#pragma once

#include <cstdint>
#include <cstring>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace convexcut::simulation {

using Floats = float __attribute__((vector_size(16)));
using Masks = std::int32_t __attribute__((vector_size(16)));  // all bits, or none

[[nodiscard]] inline Floats all(float value) noexcept { return Floats{value, value, value, value}; }
[[nodiscard]] inline Floats larger(Floats a, Floats b) noexcept { return a > b ? a : b; }
[[nodiscard]] inline Floats smaller(Floats a, Floats b) noexcept { return a < b ? a : b; }

[[nodiscard]] inline Floats load(const float* from) noexcept {
  Floats floats;
  std::memcpy(&floats, from, sizeof floats);
  return floats;
}

// Bit 0 for the first lane, and so on.
[[nodiscard]] inline unsigned bits_of(Masks masks) noexcept {
#ifdef __SSE2__
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(masks)));
#else
  unsigned bits = 0;
  for (unsigned lane = 0; lane < 4; ++lane) bits |= masks[lane] != 0 ? 1U << lane : 0U;
  return bits;
#endif
}

}  // namespace convexcut::simulation
