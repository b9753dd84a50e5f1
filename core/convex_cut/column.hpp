// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/workspace.hpp"

namespace convexcut {

// Workspace for one of several columns that are walked along together. Large blocks of memory begin
// at the start of a page, all of them: elements of the same index would share one set of the first
// cache, which has room for eight, and a load would wait for any store that it resembles in its
// last twelve bits. So each column begins at another part of a page.
template <class T>
class Column {
 public:
  // index: of the column among its neighbours.
  Column(std::size_t size, std::size_t index)
      : storage_(size + (kLine + index * kStep % kPage) / sizeof(T)), size_(size) {
    const auto address = std::bit_cast<std::uintptr_t>(storage_.data());
    const std::size_t to_line = (kLine - address % kLine) % kLine;
    begin_ = storage_.data() + (to_line + index * kStep % kPage) / sizeof(T);
  }
  Column(const Column&) = delete;
  Column& operator=(const Column&) = delete;

  [[nodiscard]] T* data() noexcept { return begin_; }
  [[nodiscard]] const T* data() const noexcept { return begin_; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] T& operator[](std::size_t i) noexcept { return begin_[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return begin_[i]; }
  [[nodiscard]] std::span<T> span() noexcept { return {begin_, size_}; }

 private:
  static constexpr std::size_t kLine = 64;
  static constexpr std::size_t kPage = 4096;
  static constexpr std::size_t kStep = 5 * kLine;

  Workspace<T> storage_;
  std::size_t size_;
  T* begin_;
};

}  // namespace convexcut
