// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace convexcut {

// Leaves elements of trivial types unset where std::allocator would zero them: workspace that is
// sized for the largest cloud then costs no memory until a cloud needs it.
template <class T>
class UnsetAllocator : public std::allocator<T> {
 public:
  template <class U>
  struct rebind {
    using other = UnsetAllocator<U>;
  };

  template <class U>
  void construct(U* at) noexcept(std::is_nothrow_default_constructible_v<U>) {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U, class... Arguments>
  void construct(U* at, Arguments&&... arguments) {
    std::construct_at(at, std::forward<Arguments>(arguments)...);
  }
};

// A vector whose elements are written before they are read.
template <class T>
using Workspace = std::vector<T, UnsetAllocator<T>>;

}  // namespace convexcut
