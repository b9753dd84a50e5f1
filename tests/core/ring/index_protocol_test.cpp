// SPDX-License-Identifier: Apache-2.0
//
// Every interleaving of a model of the ring's protocol, at the level of single loads and stores:
// all reachable states of one producer and one consumer are visited. The checker is itself checked
// on broken protocols, which it must refute.
//
// Not proved: that spsc_ring.hpp is the model (it is written beside it, step by step), and nothing
// about weakly ordered memory: the model is sequentially consistent. That the acquire and release
// orders suffice is argued in the header's comments and checked by ThreadSanitizer.
#include <array>
#include <compare>
#include <cstdint>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace convexcut {
namespace {

constexpr std::uint8_t kMaxCapacity = 4;

enum class Fault : std::uint8_t {
  none,
  publishes_before_filling,  // the index is stored before the slot is written
  one_slot_too_many,         // "full" is noticed one sample late
  frees_before_reading,      // the slot is given back before it is read
};

struct Setup {
  std::uint8_t capacity = 1;
  std::uint8_t claims = 4;         // that the producer makes
  std::uint8_t batch = 1;          // most samples that the consumer takes at once
  std::uint8_t index_modulus = 0;  // 0: indices never wrap; else they are reduced, as at 2^64
  std::uint8_t first_index = 0;
  Fault fault = Fault::none;
};

std::ostream& operator<<(std::ostream& out, const Setup& s) {
  return out << "capacity " << int{s.capacity} << ", claims " << int{s.claims} << ", batch "
             << int{s.batch} << ", modulus " << int{s.index_modulus};
}

// Program counters: each step does at most one shared load or store.
enum class Producer : std::uint8_t { check_cached, load_read, fill_begin, fill_end, publish, done };
enum class Consumer : std::uint8_t { load_written, read_begin, read_end, free };

struct Slot {
  std::uint8_t sample = 0;  // number of the claim that filled it, from 1
  bool being_filled = false;
  bool being_read = false;
  // NOLINTNEXTLINE(modernize-use-nullptr,readability-implicit-bool-conversion): a false alarm
  friend auto operator<=>(const Slot&, const Slot&) = default;
};

struct State {
  // shared
  std::uint8_t written = 0;
  std::uint8_t read = 0;
  std::array<Slot, kMaxCapacity> slots{};
  // producer
  Producer producer = Producer::check_cached;
  std::uint8_t read_seen = 0;
  std::uint8_t claim = 1;  // number of the claim under way
  std::uint8_t overruns = 0;
  std::uint8_t committed = 0;
  // consumer
  Consumer consumer = Consumer::load_written;
  std::uint8_t written_seen = 0;
  std::uint8_t in_batch = 0;  // samples of the current batch, and how many of them are read
  std::uint8_t batch_read = 0;
  std::uint8_t popped = 0;
  std::uint8_t last_sample = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): a false alarm
  friend auto operator<=>(const State&, const State&) = default;
};

class Model {
 public:
  explicit Model(const Setup& setup) : setup_(setup) {}

  // Visits every reachable state; returns what went wrong, or nothing.
  std::string check() {
    State start;
    start.written = start.read = start.read_seen = start.written_seen = setup_.first_index;
    std::vector<State> open{start};
    seen_.insert(start);
    while (!open.empty() && wrong_.empty()) {
      const State state = open.back();
      open.pop_back();
      std::vector<State> next;
      if (state.producer != Producer::done) next.push_back(producer_step(state));
      next.push_back(consumer_step(state));
      for (const State& s : next) {
        if (seen_.insert(s).second) open.push_back(s);
      }
      if (state.producer == Producer::done && next.back() == state) check_end(state);
    }
    if (wrong_.empty() && ends_ == 0) return "the protocol never comes to an end";
    return wrong_;
  }
  [[nodiscard]] std::size_t states() const { return seen_.size(); }

 private:
  [[nodiscard]] std::uint8_t reduce(int index) const {
    const int m = setup_.index_modulus;
    return static_cast<std::uint8_t>(m == 0 ? index : ((index % m) + m) % m);
  }
  [[nodiscard]] int distance(std::uint8_t ahead, std::uint8_t behind) const {
    return reduce(int{ahead} - int{behind});
  }
  [[nodiscard]] Slot& slot(State& s, int index) const {
    return s.slots[reduce(index) % setup_.capacity];
  }
  [[nodiscard]] bool full(const State& s) const {
    const int room = setup_.capacity + (setup_.fault == Fault::one_slot_too_many ? 1 : 0);
    return distance(s.written, s.read_seen) == room;
  }
  void fail(const std::string& what) {
    if (wrong_.empty()) wrong_ = what;
  }

  State producer_step(State s) {
    const bool publishes_first = setup_.fault == Fault::publishes_before_filling;
    const Producer begin = publishes_first ? Producer::publish : Producer::fill_begin;
    switch (s.producer) {
      case Producer::check_cached:
        s.producer = full(s) ? Producer::load_read : begin;
        break;
      case Producer::load_read:
        s.read_seen = s.read;
        s.producer = begin;
        if (full(s)) {
          ++s.overruns;
          next_claim(s);
        }
        break;
      case Producer::fill_begin: {
        Slot& target = slot(s, s.written - (publishes_first ? 1 : 0));
        if (target.being_read) fail("a slot is overwritten while it is read");
        target.being_filled = true;
        s.producer = Producer::fill_end;
        break;
      }
      case Producer::fill_end: {
        Slot& target = slot(s, s.written - (publishes_first ? 1 : 0));
        target.being_filled = false;
        target.sample = s.claim;
        s.producer = Producer::publish;
        if (publishes_first) next_claim(s);
        break;
      }
      case Producer::publish:
        s.written = reduce(s.written + 1);
        ++s.committed;
        if (publishes_first) {
          s.producer = Producer::fill_begin;
        } else {
          next_claim(s);
        }
        break;
      case Producer::done:
        break;
    }
    return s;
  }
  void next_claim(State& s) const {
    s.producer = s.claim == setup_.claims ? Producer::done : Producer::check_cached;
    ++s.claim;
  }

  State consumer_step(State s) {
    const bool frees_first = setup_.fault == Fault::frees_before_reading;
    const int base = s.read - (frees_first ? s.in_batch : 0);
    switch (s.consumer) {
      case Consumer::load_written: {
        // As available(): the shared index is looked at only when the last look does not suffice.
        if (distance(s.written_seen, s.read) < setup_.batch) s.written_seen = s.written;
        const int count = distance(s.written_seen, s.read);
        if (count == 0) break;
        if (count > setup_.capacity) fail("more samples are queued than there are slots");
        s.in_batch = static_cast<std::uint8_t>(count < setup_.batch ? count : setup_.batch);
        s.batch_read = 0;
        s.consumer = frees_first ? Consumer::free : Consumer::read_begin;
        break;
      }
      case Consumer::read_begin: {
        Slot& source = slot(s, base + s.batch_read);
        if (source.being_filled) fail("a slot is read while it is filled");
        source.being_read = true;
        s.consumer = Consumer::read_end;
        break;
      }
      case Consumer::read_end: {
        Slot& source = slot(s, base + s.batch_read);
        source.being_read = false;
        if (source.being_filled) fail("a slot was filled while it was read");
        if (source.sample <= s.last_sample) fail("a sample came twice, late or never filled");
        s.last_sample = source.sample;
        ++s.popped;
        ++s.batch_read;
        s.consumer = Consumer::read_begin;
        if (s.batch_read == s.in_batch) {
          s.consumer = frees_first ? Consumer::load_written : Consumer::free;
          if (frees_first) s.in_batch = 0;
        }
        break;
      }
      case Consumer::free:
        s.read = reduce(s.read + s.in_batch);
        s.consumer = frees_first ? Consumer::read_begin : Consumer::load_written;
        if (!frees_first) s.in_batch = s.batch_read = 0;
        break;
    }
    return s;
  }

  // The producer is done and the consumer finds nothing more.
  void check_end(const State& s) {
    ++ends_;
    if (s.popped != s.committed) fail("committed samples were lost");
    if (s.popped + s.overruns != setup_.claims) fail("claims are not samples plus overruns");
  }

  Setup setup_;
  std::set<State> seen_;
  std::string wrong_;
  std::size_t ends_ = 0;
};

class IndexProtocol : public testing::TestWithParam<Setup> {};

TEST_P(IndexProtocol, NoInterleavingLosesTearsOrReordersASample) {
  Model model(GetParam());
  EXPECT_EQ(model.check(), "");
  EXPECT_GT(model.states(), 50U);
  RecordProperty("states", static_cast<int>(model.states()));
}

INSTANTIATE_TEST_SUITE_P(CapacityOne, IndexProtocol,
                         testing::Values(Setup{.capacity = 1, .claims = 6, .batch = 1},
                                         Setup{.capacity = 1, .claims = 6, .batch = 3}));
INSTANTIATE_TEST_SUITE_P(CapacityTwo, IndexProtocol,
                         testing::Values(Setup{.capacity = 2, .claims = 7, .batch = 1},
                                         Setup{.capacity = 2, .claims = 7, .batch = 2}));
// The protocol does not need a power of two as long as the indices do not wrap.
INSTANTIATE_TEST_SUITE_P(CapacityThree, IndexProtocol,
                         testing::Values(Setup{.capacity = 3, .claims = 8, .batch = 1},
                                         Setup{.capacity = 3, .claims = 8, .batch = 2},
                                         Setup{.capacity = 3, .claims = 8, .batch = 3}));
// Index arithmetic stays right when the indices wrap, given a capacity that divides the modulus.
INSTANTIATE_TEST_SUITE_P(
    WrappingIndices, IndexProtocol,
    testing::Values(
        Setup{.capacity = 1, .claims = 6, .batch = 1, .index_modulus = 8, .first_index = 6},
        Setup{.capacity = 2, .claims = 7, .batch = 2, .index_modulus = 8, .first_index = 6},
        Setup{.capacity = 4, .claims = 8, .batch = 3, .index_modulus = 8, .first_index = 6}));

TEST(IndexProtocolChecker, RefutesPublishingBeforeFilling) {
  Model model({.capacity = 2, .claims = 4, .fault = Fault::publishes_before_filling});
  EXPECT_NE(model.check(), "");
}

TEST(IndexProtocolChecker, RefutesOneSlotTooMany) {
  Model model({.capacity = 2, .claims = 5, .fault = Fault::one_slot_too_many});
  EXPECT_NE(model.check(), "");
}

TEST(IndexProtocolChecker, RefutesFreeingBeforeReading) {
  Model model({.capacity = 1, .claims = 4, .fault = Fault::frees_before_reading});
  EXPECT_NE(model.check(), "");
}

TEST(IndexProtocolChecker, RefutesWrappingIndicesThatTheCapacityDoesNotDivide) {
  Model model({.capacity = 3, .claims = 8, .batch = 1, .index_modulus = 8, .first_index = 6});
  EXPECT_NE(model.check(), "");
}

}  // namespace
}  // namespace convexcut
