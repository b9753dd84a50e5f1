// SPDX-License-Identifier: Apache-2.0
#include "replay/feed/imu_feed.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "drivers/xsens/mtdata2.hpp"
#include "drivers/xsens/sample_time.hpp"

namespace convexcut::replay {
namespace {

constexpr std::size_t kLongestNoise = 100;
constexpr std::int64_t kTicksPerSecond = xsens::kSampleTicksPerSecond;
constexpr Duration kTick = std::chrono::microseconds{100};
// The device's own day, after which its sample time starts over.
constexpr std::int64_t kDayTicks = 864'000'000;

std::size_t header_size(wire::Bytes frame) {
  return wire::load_u8(frame, xsens::kLengthOffset) == xsens::kExtendedLength
             ? xsens::kExtendedHeaderSize
             : xsens::kHeaderSize;
}

}  // namespace

void ImuFeed::TimeItems::take(const xsens::RawItem& item, wire::WritableBytes data) {
  switch (xsens::type_of(item.data_id)) {
    case xsens::DataType::packet_counter:
      if (data.size() == sizeof(std::uint16_t)) counter = data;
      return;
    case xsens::DataType::sample_time_fine:
      if (data.size() == sizeof(std::uint32_t)) fine = data;
      return;
    case xsens::DataType::sample_time_coarse:
      if (data.size() == sizeof(std::uint32_t)) coarse = data;
      return;
    default:
      return;
  }
}

ImuFeed::ImuFeed(ImuFeedOptions options, EmulatedImu& device, const Faults& faults,
                 std::uint64_t seed)
    : options_(std::move(options)), device_(device), faults_(faults), dice_(seed) {
  rewind();
}

void ImuFeed::rewind() {
  messages_ = std::make_unique<ImuMessages>(options_.file, options_.unstamped_start);
  clock_ = xsens::SampleClock::sample_time_fine();
  newest_time_.reset();
  first_of_loop_ = true;
}

std::optional<HostTime> ImuFeed::next_stamp() {
  const ImuMessage* message = messages_->front();
  if (message == nullptr) return std::nullopt;
  return message->stamp;
}

void ImuFeed::send(const PlayedTime& time) {
  std::vector<std::byte> frame = messages_->front()->frame;
  messages_->pop();
  if (!move_time(frame, time)) return;
  if (dice_.chance(faults_.loss)) {
    ++lost_;
  } else if (put_on_line(frame)) {
    ++sent_;
  } else {
    ++unheard_;
  }
  if (dice_.chance(faults_.garbage)) {
    ++garbage_;
    device_.disturb(dice_.noise(kLongestNoise));
  }
}

bool ImuFeed::put_on_line(wire::Bytes frame) {
  constexpr int kTries = 1000;
  for (int i = 0; i < kTries; ++i) {
    if (device_.measure(frame)) return true;
    if (!options_.wait_for_line || !device_.plugged_in() || !device_.terminal().heard()) break;
    std::this_thread::sleep_for(std::chrono::microseconds{200});
  }
  return false;
}

bool ImuFeed::move_time(std::vector<std::byte>& frame, const PlayedTime& time) {
  const auto message = static_cast<xsens::MessageId>(frame[xsens::kMessageIdOffset]);
  if (message != xsens::MessageId::mtdata2) return true;
  const std::size_t header = header_size(frame);
  const wire::WritableBytes payload =
      wire::WritableBytes(frame).subspan(header, frame.size() - header - xsens::kChecksumSize);
  TimeItems items;
  const bool whole = xsens::for_each_item(payload, [&](const xsens::RawItem& item) {
    const auto at = static_cast<std::size_t>(item.data.data() - payload.data());
    items.take(item, payload.subspan(at, item.data.size()));
  });
  if (!whole) return true;
  if (!items.fine.empty() && !move_ticks(items, time)) return false;
  if (!items.counter.empty()) move_counter(items.counter);
  first_of_loop_ = false;
  frame.back() = xsens::checksum(frame);
  return true;
}

void ImuFeed::move_counter(wire::WritableBytes counter) {
  const auto recorded = wire::load_be<std::uint16_t>(counter, 0);
  if (first_of_loop_ && newest_counter_) {
    counter_shift_ = static_cast<std::uint16_t>(*newest_counter_ + 1 - recorded);
  }
  newest_counter_ = static_cast<std::uint16_t>(recorded + counter_shift_);
  wire::store_be<std::uint16_t>(counter, 0, *newest_counter_);
}

bool ImuFeed::move_ticks(const TimeItems& items, const PlayedTime& time) {
  const std::int64_t fine = wire::load_be<std::uint32_t>(items.fine, 0);
  std::int64_t ticks = fine;
  if (!items.coarse.empty()) {
    ticks = std::int64_t{wire::load_be<std::uint32_t>(items.coarse, 0)} * kTicksPerSecond +
            fine % kTicksPerSecond;
  }
  const ImuTime unwrapped = clock_.unwrap(static_cast<std::uint32_t>(ticks));
  if (!first_time_) first_time_ = unwrapped;
  const Duration gained = unwrapped - *first_time_;
  // Reads are stamped later than the device's time, and unevenly: at the seam two may overlap.
  if (first_of_loop_ && newest_sent_ && time(gained) <= *newest_sent_) return false;
  note_interval(unwrapped);
  newest_sent_ = std::max(newest_sent_.value_or(Duration::min()), time(gained));
  const std::int64_t shift = time.shift(gained) / kTick;
  if (shift == 0) return true;
  const std::int64_t wrap = fine < kDayTicks ? kDayTicks : std::int64_t{1} << 32U;
  const std::int64_t moved = ((fine + shift) % wrap + wrap) % wrap;
  wire::store_be<std::uint32_t>(items.fine, 0, static_cast<std::uint32_t>(moved));
  if (!items.coarse.empty()) {
    const std::int64_t seconds = (ticks + shift) / kTicksPerSecond;
    wire::store_be<std::uint32_t>(items.coarse, 0, static_cast<std::uint32_t>(seconds));
  }
  return true;
}

void ImuFeed::note_interval(ImuTime time) {
  const Duration step = newest_time_ ? time - *newest_time_ : Duration{0};
  if (step > Duration{0} && (interval_ == Duration{0} || step < interval_)) interval_ = step;
  newest_time_ = time;
}

}  // namespace convexcut::replay
