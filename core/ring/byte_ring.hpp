// SPDX-License-Identifier: Apache-2.0
//
// A bounded queue of records of any size between one producing and one consuming thread, in one
// preallocated piece of memory. As SpscRing, but where samples differ much in size. Design note:
// docs/design/ring.md.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "core/counter.hpp"
#include "core/ring/slot_array.hpp"

namespace convexcut {

// A record that does not fit is dropped and counted; what is queued stays in order. Every record is
// in one piece: where the end of the memory is too near, it begins at the start of it.
//
// Both indices count bytes since construction and never wrap in practice (2^64); a record is a
// header with its size, its bytes, and padding to the next header.
class ByteRing {
 public:
  // `capacity` is rounded up to a power of two, at least 1 kB. Allocates and throws
  // std::length_error or std::bad_alloc; nothing else here does either.
  explicit ByteRing(std::size_t capacity)
      : memory_(std::bit_ceil(std::max(capacity, kLeastCapacity))), bytes_(memory_.data()) {}
  ByteRing(const ByteRing&) = delete;
  ByteRing& operator=(const ByteRing&) = delete;

  // Records up to this size always fit into an empty ring.
  [[nodiscard]] std::size_t largest_record() const noexcept { return memory_.size() / 2 - kHeader; }

  // Producer thread. Room for a record of `size` bytes, aligned for any fundamental type of up to 8
  // bytes, or an empty span when there is none (one overrun counted per call). Claiming again
  // before commit() gives other room for the same record. Precondition: size > 0.
  [[nodiscard]] std::span<std::byte> claim(std::size_t size) noexcept {
    if (size > largest_record()) return refuse();
    // Relaxed: this thread's own last store.
    const std::size_t written = producer_.written.load(std::memory_order_relaxed);
    const std::size_t at = written & (memory_.size() - 1);
    const std::size_t needed = kHeader + padded(size);
    const std::size_t to_end = memory_.size() - at;
    const std::size_t skipped = to_end < needed ? to_end : 0;
    const std::size_t end = written + skipped + needed;
    if (end - producer_.read_seen > memory_.size()) {
      // SYNC bytes freed: pairs with the release store in pop(). What the consumer read there
      // happened before we overwrite it.
      producer_.read_seen = consumer_.read.load(std::memory_order_acquire);
      if (end - producer_.read_seen > memory_.size()) return refuse();
    }
    if (skipped > 0) store_header(at, kSkip);
    const std::size_t begin = skipped > 0 ? 0 : at;
    store_header(begin, size);
    producer_.claimed = end;
    return {bytes_ + begin + kHeader, size};
  }

  // Producer thread. Hands the claimed record to the consumer. Precondition: the last claim() since
  // the previous commit() gave room.
  void commit() noexcept {
    // SYNC record published: pairs with the acquire load in front(). The record's bytes happened
    // before the consumer sees the new index.
    producer_.written.store(producer_.claimed, std::memory_order_release);
  }

  // Consumer thread. The oldest record, or an empty span when there is none. Valid until pop().
  [[nodiscard]] std::span<const std::byte> front() noexcept {
    // Relaxed: this thread's own last store.
    std::size_t read = consumer_.read.load(std::memory_order_relaxed);
    if (read == consumer_.written_seen) {
      // SYNC record published: pairs with the release store in commit(). The records up to the
      // index are whole before we read them.
      consumer_.written_seen = producer_.written.load(std::memory_order_acquire);
      if (read == consumer_.written_seen) return {};
    }
    std::size_t at = read & (memory_.size() - 1);
    std::size_t size = load_header(at);
    if (size == kSkip) {  // published together with the record behind it
      read += memory_.size() - at;
      at = 0;
      size = load_header(0);
    }
    consumer_.end_of_front = read + kHeader + padded(size);
    return {bytes_ + at + kHeader, size};
  }

  // Consumer thread. Gives the room of front() back. Precondition: front() gave a record since the
  // last pop().
  void pop() noexcept {
    // SYNC bytes freed: pairs with the acquire load in claim(). Our reads of the record happened
    // before the producer sees the new index.
    consumer_.read.store(consumer_.end_of_front, std::memory_order_release);
  }

  [[nodiscard]] std::size_t capacity() const noexcept { return memory_.size(); }
  // Any thread. How many claims found no room.
  [[nodiscard]] std::uint64_t overruns() const noexcept { return producer_.overruns.value(); }

 private:
  static constexpr std::size_t kHeader = sizeof(std::uint64_t);
  static constexpr std::size_t kLeastCapacity = 1024;
  static constexpr std::size_t kSkip = ~std::size_t{0};  // nothing more up to the end of the memory

  static constexpr std::size_t padded(std::size_t size) noexcept {
    return (size + kHeader - 1) / kHeader * kHeader;
  }

  // All positions are multiples of the header's size, so a header always fits before the end.
  void store_header(std::size_t at, std::size_t size) noexcept {
    const std::uint64_t header = size;
    std::memcpy(bytes_ + at, &header, kHeader);
  }
  [[nodiscard]] std::size_t load_header(std::size_t at) const noexcept {
    std::uint64_t header = 0;
    std::memcpy(&header, bytes_ + at, kHeader);
    return header;
  }
  std::span<std::byte> refuse() noexcept {
    producer_.overruns.add();
    return {};
  }

  struct alignas(kCacheLine) ProducerLine {
    std::atomic<std::size_t> written{0};
    std::size_t claimed = 0;
    std::size_t read_seen = 0;
    Counter overruns;
  };
  struct alignas(kCacheLine) ConsumerLine {
    std::atomic<std::size_t> read{0};
    std::size_t end_of_front = 0;
    std::size_t written_seen = 0;
  };
  static_assert(std::atomic<std::size_t>::is_always_lock_free);
  static_assert(sizeof(std::size_t) == sizeof(std::uint64_t));
  static_assert(sizeof(ProducerLine) == kCacheLine && sizeof(ConsumerLine) == kCacheLine);

  // Read by both, written by none after construction.
  SlotArray<std::byte> memory_;
  std::byte* bytes_;

  ProducerLine producer_;
  ConsumerLine consumer_;
};

}  // namespace convexcut
