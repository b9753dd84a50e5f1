// SPDX-License-Identifier: Apache-2.0
#include "daemon/realtime/thread_figures.hpp"

#include <charconv>
#include <chrono>
#include <fstream>
#include <string>

#include <unistd.h>

#include "daemon/realtime/allocation_watch.hpp"

namespace convexcut::daemon {
namespace {

// Fields of the file, counted from 1 as in proc(5).
constexpr int kFirstAfterName = 3;
constexpr int kMinorFaults = 10;
constexpr int kMajorFaults = 12;
constexpr int kUserTime = 14;
constexpr int kSystemTime = 15;

}  // namespace

std::optional<ThreadUsage> parse_thread_usage(std::string_view stat,
                                              long ticks_per_second) noexcept {
  // The name is in parentheses and may hold any character, also these.
  const std::size_t name_end = stat.rfind(')');
  if (name_end == std::string_view::npos || ticks_per_second <= 0) return std::nullopt;
  std::string_view rest = stat.substr(name_end + 1);
  ThreadUsage usage;
  std::uint64_t ticks = 0;
  for (int field = kFirstAfterName; field <= kSystemTime; ++field) {
    const std::size_t begin = rest.find_first_not_of(" \n");
    if (begin == std::string_view::npos) return std::nullopt;
    rest.remove_prefix(begin);
    const std::string_view text = rest.substr(0, rest.find_first_of(" \n"));
    rest.remove_prefix(text.size());
    if (field != kMinorFaults && field != kMajorFaults && field < kUserTime) continue;
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    if (field == kMinorFaults) usage.minor_faults = value;
    if (field == kMajorFaults) usage.major_faults = value;
    if (field >= kUserTime) ticks += value;
  }
  usage.cpu_time =
      Duration{std::chrono::seconds{1}} * static_cast<Duration::rep>(ticks) / ticks_per_second;
  return usage;
}

std::optional<ThreadUsage> thread_usage(pid_t tid) {
  std::ifstream file("/proc/self/task/" + std::to_string(tid) + "/stat");
  std::string line;
  if (!std::getline(file, line)) return std::nullopt;
  return parse_thread_usage(line, ::sysconf(_SC_CLK_TCK));
}

void ThreadRegister::enter(const char* name, ThreadRole role) noexcept {
  // Relaxed: it only deals the entries out; the content is published by ready_.
  const std::size_t index = count_.fetch_add(1, std::memory_order_relaxed);
  if (index >= kMaxThreads) return;
  Entry& entry = entries_[index];
  entry.name = name;
  entry.role = role;
  entry.tid = ::gettid();
  watch_allocations(&entry.allocations);
  ready_[index].store(true, std::memory_order_release);  // pairs with mark_steady(), figures()
}

void ThreadRegister::leave() noexcept { watch_allocations(nullptr); }

void ThreadRegister::mark_steady() {
  for (std::size_t i = 0; i < kMaxThreads; ++i) {
    if (!ready_[i].load(std::memory_order_acquire)) continue;  // pairs with enter()
    Entry& entry = entries_[i];
    read(entry);
    entry.before = entry.newest;
    entry.allocations_before = entry.allocations.value();
  }
}

std::vector<ThreadFigures> ThreadRegister::figures() {
  std::vector<ThreadFigures> all;
  for (std::size_t i = 0; i < kMaxThreads; ++i) {
    if (!ready_[i].load(std::memory_order_acquire)) continue;  // pairs with enter()
    Entry& entry = entries_[i];
    read(entry);
    all.push_back({.name = entry.name,
                   .role = entry.role,
                   .allocations = entry.allocations.value() - entry.allocations_before,
                   .minor_faults = entry.newest.minor_faults - entry.before.minor_faults,
                   .major_faults = entry.newest.major_faults - entry.before.major_faults,
                   .cpu_time = entry.newest.cpu_time});
  }
  return all;
}

void ThreadRegister::read(Entry& entry) {
  if (const auto usage = thread_usage(entry.tid)) entry.newest = *usage;
}

}  // namespace convexcut::daemon
