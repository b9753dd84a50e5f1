// SPDX-License-Identifier: Apache-2.0
#include "core/scan/scan_cutter.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

namespace convexcut {
namespace {

// Point times are uint32 nanoseconds after the scan's first firing: 4.29 s.
constexpr Duration kLongest = std::chrono::seconds{4};
// Fewer steps than these do not tell the mean step to a firing in a revolution.
constexpr std::int64_t kStepsToMeasure = 100;
constexpr double kStandingHz = 0.1;
constexpr double kNanosecondsPerSecond = 1e9;

std::int64_t floor_divide(std::int64_t value, std::int64_t by) noexcept {
  const std::int64_t quotient = value / by;
  return value % by < 0 ? quotient - 1 : quotient;
}

std::uint32_t rounded(double positive) noexcept {
  return static_cast<std::uint32_t>(std::llround(positive));
}

void require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

}  // namespace

void reserve(Scan& scan, std::size_t max_returns, std::size_t max_firings) {
  scan.firings.reserve(max_firings);
  scan.x_lidar.reserve(max_returns);
  scan.y_lidar.reserve(max_returns);
  scan.z_lidar.reserve(max_returns);
  scan.intensity.reserve(max_returns);
  scan.ring.reserve(max_returns);
  scan.time_ns.reserve(max_returns);
}

ScanCutter::ScanCutter(const CutOptions& options, std::size_t max_returns_per_scan,
                       std::size_t max_firings)
    : options_(options),
      min_range_m_(static_cast<float>(options.min_range_m)),
      max_range_m_(static_cast<float>(options.max_range_m)) {
  require(options.window > Duration::zero() && options.window <= kLongest,
          "the window of a scan is more than 0 and at most 4 s");
  require(options.timeout > Duration::zero() && options.timeout <= kLongest,
          "the timeout of a scan is more than 0 and at most 4 s");
  require(options.min_range_m <= options.max_range_m,
          "the minimum range of a scan is above the maximum");
  reserve(scan_, max_returns_per_scan, max_firings);
}

void ScanCutter::push(const ReturnBatch& batch, LidarTime first_firing, OnScan on_scan) noexcept {
  if (started_ && first_firing <= batch_time_) {
    if (batch_time_ - first_firing <= options_.timeout) return counters_.stale_batches.add();
    finish(on_scan);
  }
  if (!started_) firing_time_ = first_firing;
  started_ = true;
  batch_time_ = first_firing;
  firing_period_ = Duration{batch.firing_period_ns};

  const std::uint64_t glitches = rotor_.glitches();
  const bool all = selects_all(batch);
  for (std::size_t i = 0; i < batch.firing_count; ++i) {
    const Firing& firing = batch.firings[i];
    // A sensor clock that is being disciplined may let two batches overlap by microseconds.
    firing_time_ = std::max(firing_time_, first_firing + Duration{firing.offset_ns});
    const std::int64_t sector = sector_of(firing, firing_time_);
    if (open_ && sector > sector_) {
      copy_run(batch);
      end(ScanEnd::cut, on_scan);
    } else if (open_ && options_.mode == CutOptions::Mode::revolution &&
               firing_time_ - scan_.first_firing >= options_.timeout) {
      copy_run(batch);
      end(ScanEnd::timeout, on_scan);
    }
    if (!open_) begin(firing_time_, sector);
    add(batch, firing, firing_time_, all);
  }
  copy_run(batch);
  counters_.azimuth_glitches.add(rotor_.glitches() - glitches);
}

void ScanCutter::finish(OnScan on_scan) noexcept {
  if (open_) end(ScanEnd::end_of_input, on_scan);
  rotor_.reset();
  started_ = false;
}

void ScanCutter::begin(LidarTime first_firing, std::int64_t sector) noexcept {
  scan_.firings.clear();
  scan_.x_lidar.clear();
  scan_.y_lidar.clear();
  scan_.z_lidar.clear();
  scan_.intensity.clear();
  scan_.ring.clear();
  scan_.time_ns.clear();
  max_firings_ = scan_.firings.capacity();
  max_returns_ =
      std::min({scan_.x_lidar.capacity(), scan_.y_lidar.capacity(), scan_.z_lidar.capacity(),
                scan_.intensity.capacity(), scan_.ring.capacity(), scan_.time_ns.capacity()});
  scan_.index = next_index_++;
  scan_.first_firing = first_firing;
  scan_.overflow_returns = 0;
  sector_ = sector;
  sweep_at_begin_ = rotor_.sweep();
  open_ = true;
}

void ScanCutter::end(ScanEnd why, OnScan on_scan) noexcept {
  scan_.end = why;
  measure_rotor();
  open_ = false;
  on_scan(scan_);
}

std::int64_t ScanCutter::sector_of(const Firing& firing, LidarTime time) noexcept {
  const std::int64_t turned = rotor_.turned(firing.azimuth, time, firing_period_);
  if (options_.mode == CutOptions::Mode::clock) {
    return floor_divide(to_ns(time), options_.window.count());
  }
  return floor_divide(turned - options_.cut_azimuth.microdegrees(), Azimuth::kFullTurn);
}

void ScanCutter::add(const ReturnBatch& batch, const Firing& firing, LidarTime time,
                     bool all) noexcept {
  scan_.last_firing = time;
  const bool has_room = scan_.firings.size() < max_firings_;
  const auto first_in_scan = static_cast<std::uint32_t>(returns());
  const std::size_t last = std::size_t{firing.first_return} + firing.return_count;
  std::size_t begin = firing.first_return;
  while (begin < last) {
    std::size_t end = all ? last : begin;
    while (end < last && selects(batch, end)) ++end;
    add_run(batch, begin, end, has_room ? max_returns_ - returns() : 0);
    begin = end + 1;  // the one that is not wanted
  }
  if (!has_room) return;
  scan_.firings.push_back(
      {time, first_in_scan, static_cast<std::uint32_t>(returns()) - first_in_scan});
}

void ScanCutter::add_run(const ReturnBatch& batch, std::size_t begin, std::size_t end,
                         std::size_t room) noexcept {
  const std::size_t count = std::min(end - begin, room);
  scan_.overflow_returns += static_cast<std::uint32_t>(end - begin - count);
  if (begin != run_end_) copy_run(batch);
  if (run_begin_ == run_end_) run_begin_ = run_end_ = begin;
  run_end_ += count;
}

void ScanCutter::copy_run(const ReturnBatch& batch) noexcept {
  const auto append = [this](auto& to, const auto& from) {
    to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(run_begin_),
              from.begin() + static_cast<std::ptrdiff_t>(run_end_));
  };
  append(scan_.x_lidar, batch.x_lidar);
  append(scan_.y_lidar, batch.y_lidar);
  append(scan_.z_lidar, batch.z_lidar);
  append(scan_.intensity, batch.intensity);
  append(scan_.ring, batch.ring);
  const std::size_t first = scan_.time_ns.size();
  append(scan_.time_ns, batch.offset_ns);
  const std::int64_t batch_after_scan = (batch_time_ - scan_.first_firing).count();
  for (std::uint32_t& time_ns : std::span(scan_.time_ns).subspan(first)) {
    // Negative only in batches that overlap.
    time_ns = static_cast<std::uint32_t>(std::max<std::int64_t>(batch_after_scan + time_ns, 0));
  }
  run_begin_ = run_end_ = 0;
}

bool ScanCutter::selects(const ReturnBatch& batch, std::size_t i) const noexcept {
  if (batch.range_m[i] < min_range_m_ || batch.range_m[i] > max_range_m_) return false;
  switch (options_.echoes) {
    case CutOptions::Echoes::farthest:
      return batch.farthest[i];
    case CutOptions::Echoes::last:
      return batch.echo[i] != Echo::strongest;
    case CutOptions::Echoes::strongest:
      return batch.echo[i] != Echo::last;
    case CutOptions::Echoes::both:
      return true;
  }
  return true;
}

// Whether selects() holds for all returns: it mostly does. Without branches, to be vectorised.
bool ScanCutter::selects_all(const ReturnBatch& batch) const noexcept {
  const std::size_t count = batch.return_count;
  unsigned unwanted = 0;
  for (std::size_t i = 0; i < count; ++i) {
    unwanted |= static_cast<unsigned>(batch.range_m[i] < min_range_m_) |
                static_cast<unsigned>(batch.range_m[i] > max_range_m_);
  }
  for (std::size_t i = 0; i < count; ++i) {
    // A dual-return echo: the options tell.
    unwanted |= static_cast<unsigned>(batch.echo[i] != Echo::only);
  }
  return unwanted == 0;
}

// What a whole scan would have had, from this scan's own steps where it has enough of them.
void ScanCutter::measure_rotor() noexcept {
  const Sweep& sweep = rotor_.sweep();
  const std::int64_t steps = sweep.steps - sweep_at_begin_.steps;
  double turns_per_firing =
      rotor_.rate_hz() * static_cast<double>(firing_period_.count()) / kNanosecondsPerSecond;
  double hz = rotor_.rate_hz();
  if (steps >= kStepsToMeasure) {
    const double turns =
        static_cast<double>(sweep.microdegrees - sweep_at_begin_.microdegrees) / Azimuth::kFullTurn;
    turns_per_firing = turns / static_cast<double>(steps);
    hz = turns * kNanosecondsPerSecond /
         static_cast<double>((sweep.time - sweep_at_begin_.time).count());
  }
  scan_.rotor_hz = std::max(hz, 0.0);
  const bool turns = hz >= kStandingHz;
  if (options_.mode == CutOptions::Mode::clock) {
    const auto window = static_cast<double>(options_.window.count());
    const auto period = static_cast<double>(firing_period_.count());
    scan_.expected_firings = period > 0.0 ? rounded(window / period) : 0;
  } else {
    scan_.expected_firings = turns && turns_per_firing > 0.0 ? rounded(1.0 / turns_per_firing) : 0;
  }
}

}  // namespace convexcut
