// SPDX-License-Identifier: Apache-2.0
//
// Throughput of the ring between two threads, beside boost::lockfree::spsc_queue in the same run
// and with the same use: one sample in at a time, everything out at a time (consume, consume_all).
// Both hold 1024 samples, except that the 8 kB slots are 128. The two threads are pinned to two
// cores: on one core they would share its cache and never contend. Repetitions of the two queues
// are shuffled, so that what else the machine does hits both alike.
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <pthread.h>
#include <sched.h>

#include <benchmark/benchmark.h>
#include <boost/lockfree/spsc_queue.hpp>

#include "bench/ring/ring_ratios.hpp"
#include "core/ring/spsc_ring.hpp"

namespace convexcut::bench {
namespace {

template <std::size_t Size>
struct Payload {
  std::uint64_t number = 0;
  std::array<std::uint64_t, Size / 8 - 1> rest{};

  void fill(std::uint64_t n) noexcept {
    number = n;
    if constexpr (Size > 8) rest.fill(n);
  }
  // Reads all of it, as a consumer would.
  [[nodiscard]] std::uint64_t sum() const noexcept {
    std::uint64_t total = number;
    for (const std::uint64_t word : rest) total += word;
    return total;
  }
};

template <>
struct Payload<8> {
  std::uint64_t number = 0;
  void fill(std::uint64_t n) noexcept { number = n; }
  [[nodiscard]] std::uint64_t sum() const noexcept { return number; }
};

static_assert(sizeof(Payload<8>) == 8 && sizeof(Payload<64>) == 64 &&
              sizeof(Payload<8192>) == 8192);

template <std::size_t Size>
constexpr std::size_t kCapacity = Size >= 4096 ? 128 : 1024;

// Ours: filled in place.
template <std::size_t Size>
struct Ours {
  SpscRing<Payload<Size>> ring{kCapacity<Size>};

  bool push(std::uint64_t number) noexcept {
    Payload<Size>* slot = ring.claim();
    if (slot == nullptr) return false;
    slot->fill(number);
    ring.commit();
    return true;
  }
  std::size_t drain(std::uint64_t& sum) noexcept {
    return ring.consume([&](const Payload<Size>& payload) noexcept { sum += payload.sum(); });
  }
};

// The peer: filled outside and copied in, since it has no way to fill in place.
template <std::size_t Size>
struct Boost {
  boost::lockfree::spsc_queue<Payload<Size>> queue{kCapacity<Size>};

  bool push(std::uint64_t number) {
    Payload<Size> payload;
    payload.fill(number);
    return queue.push(payload);
  }
  std::size_t drain(std::uint64_t& sum) {
    return queue.consume_all([&](const Payload<Size>& payload) { sum += payload.sum(); });
  }
};

// Pins the calling thread to the `n`th core that this process may use; without effect when it may
// use fewer.
void pin_to_core(int n) noexcept {
  static const cpu_set_t allowed = [] {
    cpu_set_t set;
    CPU_ZERO(&set);
    ::sched_getaffinity(0, sizeof(set), &set);
    return set;
  }();
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (!CPU_ISSET(static_cast<unsigned>(core), &allowed) || n-- != 0) continue;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<unsigned>(core), &one);
    ::pthread_setaffinity_np(::pthread_self(), sizeof(one), &one);
    return;
  }
}

// Waits for the other side: briefly by spinning, then by giving the core away.
class Backoff {
 public:
  void wait() noexcept {
    if (++turns_ % 64 == 0) std::this_thread::yield();
  }

 private:
  unsigned turns_ = 0;
};

// A batch of `count` samples from this thread to another; the time covers first push to last pop.
template <class Queue>
void transfer(benchmark::State& state, std::uint64_t count) {
  Queue queue;
  std::atomic<std::uint64_t> wanted{0};  // samples that the consumer is to take in all
  std::atomic<std::uint64_t> taken{0};
  std::atomic<bool> stop{false};
  std::uint64_t sum = 0;
  pin_to_core(0);
  std::thread consumer([&] {
    pin_to_core(1);
    std::uint64_t total = 0;
    Backoff backoff;
    while (!stop.load(std::memory_order_acquire)) {  // pairs with the store at the end
      const std::size_t got = queue.drain(sum);
      total += got;
      if (got == 0) backoff.wait();
      // Release: pairs with the acquire load below; told once a batch, not once a sample.
      if (got != 0 && total == wanted.load(std::memory_order_relaxed)) {
        taken.store(total, std::memory_order_release);
      }
    }
  });
  std::uint64_t sent = 0;
  for (auto _ : state) {
    wanted.store(sent + count, std::memory_order_relaxed);
    Backoff backoff;
    for (std::uint64_t i = 0; i < count; ++i) {
      while (!queue.push(sent + i)) backoff.wait();
    }
    sent += count;
    while (taken.load(std::memory_order_acquire) != sent) backoff.wait();  // pairs with its store
  }
  stop.store(true, std::memory_order_release);  // pairs with the consumer's load
  consumer.join();
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(static_cast<std::int64_t>(sent));
}

template <template <std::size_t> class Queue, std::size_t Size>
void add(const std::string& name) {
  constexpr std::uint64_t kCount = Size >= 4096 ? 2'000 : 200'000;
  benchmark::RegisterBenchmark(
      name.c_str(), [](benchmark::State& state) { transfer<Queue<Size>>(state, kCount); })
      ->UseRealTime()
      ->MinTime(0.05)
      ->Repetitions(15)
      ->DisplayAggregatesOnly(true)
      ->Unit(benchmark::kMillisecond);
}

// Takes `--json FILE` out of the arguments; what remains is Google Benchmark's.
std::string take_json_option(std::vector<char*>& arguments) {
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    if (std::string_view(arguments[i]) != "--json") continue;
    if (i + 1 == arguments.size()) throw std::invalid_argument("--json: expected a file name");
    std::string file = arguments[i + 1];
    const auto at = arguments.begin() + static_cast<std::ptrdiff_t>(i);
    arguments.erase(at, at + 2);
    return file;
  }
  return {};
}

int run(std::vector<char*> arguments) {
  const std::string json = take_json_option(arguments);
  std::string shuffle = "--benchmark_enable_random_interleaving=true";
  arguments.push_back(shuffle.data());
  int count = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;

  add<Ours, 8>("ring/8B");
  add<Boost, 8>("boost/8B");
  add<Ours, 64>("ring/64B");
  add<Boost, 64>("boost/64B");
  add<Ours, 8192>("ring/8kB_in_place");
  add<Boost, 8192>("boost/8kB_copied");

  RatioReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  benchmark::Shutdown();
  const std::vector<NamedRatio> ratios = {
      {"ring_ratio_8B", reporter.ratio("ring/8B", "boost/8B")},
      {"ring_ratio_64B", reporter.ratio("ring/64B", "boost/64B")},
      {"ring_ratio_8kB", reporter.ratio("ring/8kB_in_place", "boost/8kB_copied")}};
  if (!json.empty()) write_json(json, ratios);
  for (const NamedRatio& ratio : ratios) {
    std::cout << (&ratio == ratios.data() ? "" : " ") << ratio.name << "=" << ratio.value;
  }
  std::cout << std::endl;
  return 0;
}

}  // namespace
}  // namespace convexcut::bench

int main(int argc, char** argv) {
  try {
    return convexcut::bench::run(std::vector<char*>(argv, argv + argc));
  } catch (const std::invalid_argument& error) {
    std::cerr << "bench_ring: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "bench_ring: " << error.what() << '\n';
    return 1;
  }
}
