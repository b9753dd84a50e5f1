// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include <sys/mman.h>

namespace convexcut {

// Leaves elements of trivial types unset where std::allocator would zero them: workspace that is
// sized for the largest cloud then costs no memory until a cloud needs it. Large blocks ask for
// huge pages: what is read and written at many places at once would wait for the tables of small
// ones.
template <class T>
class UnsetAllocator : public std::allocator<T> {
 public:
  template <class U>
  struct rebind {
    using other = UnsetAllocator<U>;
  };

  [[nodiscard]] T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kLargeBytes) return std::allocator<T>::allocate(count);
    void* const block = ::operator new (bytes, std::align_val_t{kHugePageBytes});
    // A wish: where the system has no huge pages to give, small ones do.
    static_cast<void>(::madvise(block, bytes, MADV_HUGEPAGE));
    return static_cast<T*>(block);
  }
  void deallocate(T* block, std::size_t count) noexcept {
    if (count * sizeof(T) < kLargeBytes) {
      std::allocator<T>::deallocate(block, count);
    } else {
      ::operator delete (block, std::align_val_t{kHugePageBytes});
    }
  }

  template <class U>
  void construct(U* at) noexcept(std::is_nothrow_default_constructible_v<U>) {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U, class... Arguments>
  void construct(U* at, Arguments&&... arguments) {
    std::construct_at(at, std::forward<Arguments>(arguments)...);
  }

 private:
  static constexpr std::size_t kHugePageBytes = std::size_t{1} << 21U;
  // Blocks of one revolution are smaller, and stay as small as they are used.
  static constexpr std::size_t kLargeBytes = 2 * kHugePageBytes;
};

// A vector whose elements are written before they are read.
template <class T>
using Workspace = std::vector<T, UnsetAllocator<T>>;

}  // namespace convexcut
