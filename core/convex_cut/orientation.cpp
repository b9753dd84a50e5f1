// SPDX-License-Identifier: Apache-2.0
#include "core/convex_cut/orientation.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace convexcut {
namespace {

// An exact sum: components that do not overlap, in increasing magnitude (Grow-Expansion).
class Expansion {
 public:
  void add_product(double a, double b) noexcept {
    const double product = a * b;
    add(std::fma(a, b, -product));  // exactly what the product lost
    add(product);
  }
  [[nodiscard]] int sign() const noexcept {
    for (std::size_t i = size_; i > 0; --i) {
      if (components_[i - 1] != 0.0) return components_[i - 1] > 0.0 ? 1 : -1;
    }
    return 0;
  }

 private:
  void add(double term) noexcept {
    double carry = term;
    for (std::size_t i = 0; i < size_; ++i) {
      // Two-Sum: sum + lost equals carry + component exactly.
      const double component = components_[i];
      const double sum = carry + component;
      const double virtual_component = sum - carry;
      const double lost = (carry - (sum - virtual_component)) + (component - virtual_component);
      components_[i] = lost;
      carry = sum;
    }
    components_[size_++] = carry;
  }

  std::array<double, 12> components_{};  // six products, two components each
  std::size_t size_ = 0;
};

}  // namespace

int detail::exact_orientation(const SlicePoint& a, const SlicePoint& b,
                              const SlicePoint& c) noexcept {
  Expansion determinant;
  determinant.add_product(a.u, b.z);
  determinant.add_product(-a.u, c.z);
  determinant.add_product(-c.u, b.z);
  determinant.add_product(-a.z, b.u);
  determinant.add_product(a.z, c.u);
  determinant.add_product(c.z, b.u);
  return determinant.sign();
}

}  // namespace convexcut
