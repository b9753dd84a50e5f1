// SPDX-License-Identifier: Apache-2.0
//
// A bounded queue between one producing and one consuming thread. The producer fills slots in
// place, the consumer reads them in place: nothing is copied, allocated or locked, and neither side
// ever waits for the other. Design note: docs/design/ring.md.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "core/counter.hpp"
#include "core/ring/slot_array.hpp"

namespace convexcut {

// When the ring is full the newest sample is dropped and counted: what is queued stays in order and
// a slot that the consumer is reading is never overwritten.
//
// Both indices count samples since construction and never wrap in practice (2^64); the slot of a
// sample is its index modulo the capacity. written - read is the number of queued samples.
template <class T>
class SpscRing {
  static_assert(std::is_default_constructible_v<T>, "slots are made once and then reused");

 public:
  // Room for at least `capacity` samples: rounded up to a power of two, at least 1. Allocates and
  // throws std::length_error or std::bad_alloc; nothing else here does either.
  explicit SpscRing(std::size_t capacity)
      : slots_(round_up(capacity)), mask_(slots_.size() - 1), slot_(slots_.data()) {}
  SpscRing(const SpscRing&) = delete;
  SpscRing& operator=(const SpscRing&) = delete;

  // Producer thread. The slot to fill, still holding an earlier sample, or null when the ring is
  // full (one overrun counted per call). Claiming again before commit() gives the same slot.
  [[nodiscard]] T* claim() noexcept {
    // Relaxed: this thread's own last store.
    const std::size_t written = producer_.written.load(std::memory_order_relaxed);
    if (written - producer_.read_seen == slots_.size()) {
      // SYNC slot freed: pairs with the release store in release(). What the consumer read from
      // the slot happened before we overwrite it.
      producer_.read_seen = consumer_.read.load(std::memory_order_acquire);
      if (written - producer_.read_seen == slots_.size()) {
        producer_.overruns.add();
        return nullptr;
      }
    }
    return slot_ + (written & mask_);
  }

  // Producer thread. Hands the claimed slot to the consumer. Precondition: the last claim() since
  // the previous commit() gave a slot.
  void commit() noexcept {
    // Relaxed: this thread's own last store.
    const std::size_t written = producer_.written.load(std::memory_order_relaxed);
    assert(written - producer_.read_seen < slots_.size() && "commit() without a claimed slot");
    // SYNC sample published: pairs with the acquire load in available(). The slot's content
    // happened before the consumer sees the new index.
    producer_.written.store(written + 1, std::memory_order_release);
  }

  // Consumer thread. The oldest sample, or null when there is none. Stays valid until pop().
  [[nodiscard]] T* front() noexcept {
    // Relaxed: this thread's own last store.
    const std::size_t read = consumer_.read.load(std::memory_order_relaxed);
    return available(read, 1) == 0 ? nullptr : slot_ + (read & mask_);
  }

  // Consumer thread. Gives the slot of front() back. Precondition: front() gave one since the last
  // pop().
  void pop() noexcept {
    // Relaxed: this thread's own last store.
    const std::size_t read = consumer_.read.load(std::memory_order_relaxed);
    assert(read != consumer_.written_seen && "pop() from an empty ring");
    release(read + 1);
  }

  // Consumer thread. Calls use(T&) for up to `most` samples, oldest first, and gives their slots
  // back together: one store that the producer has to fetch, however many samples. `use` must be
  // noexcept, since an exception half way would leave it open which samples were used. Returns how
  // many there were.
  template <class Use>
  std::size_t consume(Use&& use,
                      std::size_t most = std::numeric_limits<std::size_t>::max()) noexcept {
    static_assert(std::is_nothrow_invocable_v<Use&, T&>, "declare the callable noexcept");
    // Relaxed: this thread's own last store.
    const std::size_t read = consumer_.read.load(std::memory_order_relaxed);
    const std::size_t count = std::min(available(read, most), most);
    if (count == 0) return 0;
    for (std::size_t i = read; i != read + count; ++i) use(slot_[i & mask_]);
    release(read + count);
    return count;
  }

  // Any thread. How many samples were queued a moment ago, 0 … capacity().
  [[nodiscard]] std::size_t size_approx() const noexcept {
    // Acquire: pairs with the release store in release(). The consumer had seen `written` that far
    // before, so that the load below cannot give less and the difference cannot be negative.
    const std::size_t read = consumer_.read.load(std::memory_order_acquire);
    // Relaxed: only a number is wanted, no slot is touched.
    const std::size_t written = producer_.written.load(std::memory_order_relaxed);
    return std::min(written - read, slots_.size());
  }

  [[nodiscard]] std::size_t capacity() const noexcept { return slots_.size(); }

  // Any thread. How many claims found the ring full.
  [[nodiscard]] std::uint64_t overruns() const noexcept { return producer_.overruns.value(); }

 private:
  // Each side keeps its own index, and what it last saw of the other's, on a line of its own. The
  // other side's line is fetched only when the copy no longer answers the question.
  struct alignas(kCacheLine) ProducerLine {
    std::atomic<std::size_t> written{0};
    std::size_t read_seen = 0;
    Counter overruns;
  };
  struct alignas(kCacheLine) ConsumerLine {
    std::atomic<std::size_t> read{0};
    std::size_t written_seen = 0;
  };
  static_assert(std::atomic<std::size_t>::is_always_lock_free);
  static_assert(alignof(ProducerLine) == kCacheLine && alignof(ConsumerLine) == kCacheLine);
  static_assert(sizeof(ProducerLine) == kCacheLine, "all of the producer's state is on one line");
  static_assert(sizeof(ConsumerLine) == kCacheLine, "all of the consumer's state is on one line");

  static std::size_t round_up(std::size_t capacity) {
    constexpr std::size_t kLargest = std::bit_floor(std::numeric_limits<std::size_t>::max());
    if (capacity > kLargest) throw std::length_error("ring capacity does not fit into memory");
    return std::bit_ceil(std::max<std::size_t>(capacity, 1));
  }

  // Consumer thread. Queued samples; looks at the producer's line only when the last look does not
  // give `wanted`.
  [[nodiscard]] std::size_t available(std::size_t read, std::size_t wanted) noexcept {
    if (consumer_.written_seen - read < wanted) {
      // SYNC sample published: pairs with the release store in commit(). The slots up to the index
      // are filled before we read them.
      consumer_.written_seen = producer_.written.load(std::memory_order_acquire);
    }
    return consumer_.written_seen - read;
  }

  // Consumer thread.
  void release(std::size_t read) noexcept {
    // SYNC slot freed: pairs with the acquire load in claim(). Our reads of the slots happened
    // before the producer sees the new index.
    consumer_.read.store(read, std::memory_order_release);
  }

  // Read by both, written by none after construction.
  SlotArray<T> slots_;
  std::size_t mask_;
  T* slot_;

  ProducerLine producer_;
  ConsumerLine consumer_;
};

}  // namespace convexcut
