// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/convex_cut/slice_kernels.hpp"
#include "tests/core/convex_cut/clouds.hpp"

namespace convexcut::test {

// The columns of one slice, with the room that the kernels ask for.
struct Columns {
  explicit Columns(std::size_t count)
      : u(count + kKernelPadding), z(count + kKernelPadding), position(count + kKernelPadding) {}
  [[nodiscard]] SliceColumns view() { return {u.data(), z.data(), position.data()}; }
  std::vector<float> u, z;
  std::vector<std::uint32_t> position;
};

[[nodiscard]] inline Columns random_columns(std::size_t count, Random& random) {
  Columns columns(count);
  for (std::size_t k = 0; k < count; ++k) {
    columns.u[k] = static_cast<float>(random.uniform(-2, 2));
    columns.z[k] = static_cast<float>(random.uniform(-2, 2));
    columns.position[k] = static_cast<std::uint32_t>(k) | (random.index(3) == 0 ? kMarked : 0U);
  }
  return columns;
}

}  // namespace convexcut::test
