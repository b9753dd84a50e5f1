// SPDX-License-Identifier: Apache-2.0
#include "replay/feed/player.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <stdexcept>
#include <utility>

#include <poll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>

namespace convexcut::replay {
namespace {

// A terminal that nobody has open cannot be waited for; it is looked at this often.
constexpr Duration kLongestNap = std::chrono::milliseconds{20};
constexpr Duration kLoopStep = std::chrono::microseconds{100};  // of SampleTimeFine
constexpr auto kTimeToRead = std::chrono::milliseconds{250};
constexpr auto kStartDelay = std::chrono::milliseconds{20};

live::FileDescriptor stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return live::FileDescriptor(::signalfd(-1, &signals, SFD_NONBLOCK | SFD_CLOEXEC));
}

}  // namespace

Player::Player(const PlayerOptions& options, const std::vector<Feed*>& feeds, DatagramLink* link,
               EmulatedImu* imu)
    : options_(options), link_(link), imu_(imu), signals_(stop_signals()) {
  played_.rate = paced() ? options_.rate : 1.0;
  first_ = HostTime::max();
  for (Feed* feed : feeds) {
    parts_.push_back({feed});
    if (const auto stamp = feed->next_stamp()) first_ = std::min(first_, *stamp);
  }
}

Player::Part* Player::next_part() {
  Part* next = nullptr;
  HostTime oldest = HostTime::max();
  // The lidar comes first in the list and yields on a tie, as in daemon::Recordings.
  for (Part& part : parts_) {
    const auto stamp = part.feed->next_stamp();
    if (stamp && (next == nullptr || *stamp <= oldest)) {
      next = &part;
      oldest = *stamp;
    }
  }
  return next;
}

bool Player::played_nothing() const {
  return std::ranges::all_of(parts_, [](const Part& p) { return p.latest == HostTime::min(); });
}

void Player::run(const std::function<void()>& progress) {
  ::prctl(PR_SET_TIMERSLACK, 1UL);  // the usual 50 µs would be added to every wait
  wait_for_listener();
  start_ = live::Steady::now() + kStartDelay;
  do {
    play_once(progress);
    if (stopped_) break;
    if (played_nothing()) throw std::runtime_error("nothing to play between --from and --to");
    if (options_.times != 0 && played_.loop + 1 >= options_.times) break;
    if (played_.loop == 0) find_loop();
    ++played_.loop;
    for (const Part& part : parts_) part.feed->rewind();
  } while (!stopped_);
  leave_time_to_read();
  if (link_ != nullptr) {
    link_->release(live::Steady::now());
    while (!stopped_ && link_->next_due()) wait_until(*link_->next_due());
  }
}

void Player::play_once(const std::function<void()>& progress) {
  HostTime newest = HostTime::min();
  while (!stopped_) {
    Part* part = next_part();
    if (part == nullptr) return;
    // Records that are older than the one before are sent after it nevertheless.
    newest = std::max(newest, *part->feed->next_stamp());
    if (newest - first_ < options_.from || newest < loop_begin_) {
      part->feed->skip();
      continue;
    }
    if (newest - first_ >= options_.to || ends_before(newest)) return;
    send(*part->feed, newest - first_ - options_.from);
    part->first = std::min(part->first, newest);
    part->latest = std::max(part->latest, newest);
    progress();
  }
}

// When it is played again, the other sensors end with the first one.
bool Player::ends_before(HostTime stamp) const {
  const bool last = options_.times != 0 && played_.loop + 1 >= options_.times;
  if (last) return false;
  const Part& beat = parts_.front();
  if (played_.loop > 0) return stamp >= loop_end_;
  return beat.latest != HostTime::min() && !beat.feed->next_stamp() &&
         stamp >= beat.latest + beat.feed->record_interval();
}

void Player::send(Feed& feed, Duration recorded) {
  const Duration elapsed = played_(recorded);
  if (paced()) wait_until(start_ + elapsed);
  if (stopped_) return;
  if (!paced()) serve(live::Steady::now());
  if (options_.faults.stalled(elapsed)) {
    ++stalled_;
    return feed.skip();
  }
  if (paced()) max_lateness_ = std::max<Duration>(max_lateness_, this->elapsed() - elapsed);
  feed.send(played_);
}

// The length is a whole number of ticks of every device's time, so that all are moved by the same.
void Player::find_loop() {
  const Part& beat = parts_.front();
  loop_begin_ = beat.first;
  const Duration length = beat.latest - beat.first + beat.feed->record_interval();
  played_.loop_length = std::max((length + kLoopStep / 2) / kLoopStep, std::int64_t{1}) * kLoopStep;
  loop_end_ = beat.first + played_.loop_length;
}

// Pulling the plug throws away what the host has not read yet.
void Player::leave_time_to_read() {
  if (imu_ == nullptr || !imu_->plugged_in() || !imu_->terminal().heard()) return;
  const Time until = live::Steady::now() + kTimeToRead;
  while (!stopped_ && live::Steady::now() < until) wait_until(until);
}

void Player::wait_for_listener() {
  if (imu_ == nullptr) return;
  const Time until = live::Steady::now() + options_.wait;
  while (!stopped_ && !imu_->terminal().heard() && live::Steady::now() < until) {
    sleep_until(until);
    look_for_signal();
  }
}

void Player::wait_until(Time due) {
  while (!stopped_) {
    const Time now = live::Steady::now();
    serve(now);
    if (now >= due) return;
    Time next = due;
    if (link_ != nullptr && link_->next_due()) next = std::min(next, *link_->next_due());
    sleep_until(next);
  }
}

void Player::serve(Time now) {
  if (link_ != nullptr) link_->send_due(now);
  look_for_signal();
  if (imu_ == nullptr) return;
  if (options_.unplug_imu && !unplugged_ && now >= start_ + *options_.unplug_imu) {
    unplugged_ = true;
    imu_->unplug();
  }
  if (!imu_->plugged_in() && now >= start_ + *options_.unplug_imu + options_.unplugged_for) {
    imu_->plug_in();
  }
  imu_->answer();
}

void Player::look_for_signal() {
  signalfd_siginfo signal{};
  if (::read(signals_.get(), &signal, sizeof(signal)) > 0) stopped_ = true;
}

void Player::sleep_until(Time due) {
  const Duration left = std::min<Duration>(due - live::Steady::now(), kLongestNap);
  const std::timespec timeout = live::to_timespec(std::max(left, Duration{0}));
  std::array<pollfd, 2> polls{pollfd{signals_.get(), POLLIN, 0}, pollfd{-1, POLLIN, 0}};
  const bool listen = imu_ != nullptr && imu_->plugged_in() && imu_->terminal().heard();
  if (listen) polls[1].fd = imu_->terminal().fd();
  ::ppoll(polls.data(), polls.size(), &timeout, nullptr);
}

}  // namespace convexcut::replay
