// SPDX-License-Identifier: Apache-2.0
//
// Reading and writing wire formats: numbers of a stated byte order at a named offset. The caller
// has checked the length; debug builds check again.
#pragma once

#include <bit>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace convexcut::wire {

using Bytes = std::span<const std::byte>;
using WritableBytes = std::span<std::byte>;

namespace detail {
template <std::integral T>
[[nodiscard]] constexpr T byteswap(T value) noexcept {
  if constexpr (sizeof(T) == 1) return value;
  if constexpr (sizeof(T) == 2)
    return static_cast<T>(__builtin_bswap16(static_cast<std::uint16_t>(value)));
  if constexpr (sizeof(T) == 4)
    return static_cast<T>(__builtin_bswap32(static_cast<std::uint32_t>(value)));
  if constexpr (sizeof(T) == 8)
    return static_cast<T>(__builtin_bswap64(static_cast<std::uint64_t>(value)));
}

template <std::integral T, std::endian Order>
[[nodiscard]] T load(Bytes bytes, std::size_t offset) noexcept {
  assert(offset + sizeof(T) <= bytes.size());
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  if constexpr (Order != std::endian::native) value = byteswap(value);
  return value;
}

template <std::integral T, std::endian Order>
void store(WritableBytes bytes, std::size_t offset, T value) noexcept {
  assert(offset + sizeof(T) <= bytes.size());
  if constexpr (Order != std::endian::native) value = byteswap(value);
  std::memcpy(bytes.data() + offset, &value, sizeof(T));
}
}  // namespace detail

template <std::integral T>
[[nodiscard]] T load_le(Bytes bytes, std::size_t offset) noexcept {
  return detail::load<T, std::endian::little>(bytes, offset);
}

template <std::integral T>
[[nodiscard]] T load_be(Bytes bytes, std::size_t offset) noexcept {
  return detail::load<T, std::endian::big>(bytes, offset);
}

// The type is named, not deduced: it is the width on the wire.
template <std::integral T>
void store_le(WritableBytes bytes, std::size_t offset, std::type_identity_t<T> value) noexcept {
  detail::store<T, std::endian::little>(bytes, offset, value);
}

template <std::integral T>
void store_be(WritableBytes bytes, std::size_t offset, std::type_identity_t<T> value) noexcept {
  detail::store<T, std::endian::big>(bytes, offset, value);
}

[[nodiscard]] inline std::uint8_t load_u8(Bytes bytes, std::size_t offset) noexcept {
  assert(offset < bytes.size());
  return static_cast<std::uint8_t>(bytes[offset]);
}

}  // namespace convexcut::wire
