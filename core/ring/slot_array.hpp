// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>

namespace convexcut {

// What two threads write must not share a cache line, or every write of one stalls the other. 64
// bytes on x86-64 and on the ARM cores in question; a constant, because the compiler's own
// std::hardware_destructive_interference_size may change with its flags and with it our layout.
inline constexpr std::size_t kCacheLine = 64;

// A fixed number of default-initialised objects that start and end on cache-line boundaries, so
// that nothing else on the heap shares a line with them. All objects live as long as the array.
template <class T>
class SlotArray {
 public:
  // Throws std::length_error or std::bad_alloc.
  explicit SlotArray(std::size_t count) : count_(count), objects_(allocate(count)) {
    try {
      std::uninitialized_default_construct_n(objects_, count_);
    } catch (...) {
      release();
      throw;
    }
  }
  ~SlotArray() {
    std::destroy_n(objects_, count_);
    release();
  }
  SlotArray(const SlotArray&) = delete;
  SlotArray& operator=(const SlotArray&) = delete;

  [[nodiscard]] T* data() noexcept { return objects_; }
  [[nodiscard]] std::size_t size() const noexcept { return count_; }

 private:
  static constexpr std::align_val_t kAlignment{std::max(alignof(T), kCacheLine)};

  static T* allocate(std::size_t count) {
    if (count > (std::numeric_limits<std::size_t>::max() - kCacheLine) / sizeof(T)) {
      throw std::length_error("ring capacity does not fit into memory");
    }
    const std::size_t lines = (count * sizeof(T) + kCacheLine - 1) / kCacheLine;
    return static_cast<T*>(::operator new(lines* kCacheLine, kAlignment));
  }
  void release() noexcept { ::operator delete(static_cast<void*>(objects_), kAlignment); }

  std::size_t count_;
  T* objects_;
};

}  // namespace convexcut
