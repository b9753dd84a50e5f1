// SPDX-License-Identifier: Apache-2.0
#include "daemon/health/source_counts.hpp"

namespace convexcut::daemon {
namespace {

// Noise on a serial line (a wrong rate, say) is in no frame at all: so many bytes of it weigh as
// much as one bad message. The shortest MTData2 message with an orientation has 28.
constexpr std::uint64_t kBytesAMessage = 28;

}  // namespace

SourceReading reading_of(const velodyne::LidarCounters& counters) noexcept {
  SourceReading reading;
  reading.valid = counters.data_packets.value();
  reading.invalid = counters.foreign.value() + counters.wrong_length.value() +
                    counters.wrong_block_flag.value() + counters.azimuth_out_of_range.value() +
                    counters.timestamp_out_of_range.value() + counters.no_sentence.value() +
                    counters.model_unknown.value();
  return reading;
}

SourceReading reading_of(const xsens::ImuCounters& counters) noexcept {
  SourceReading reading;
  reading.valid = counters.samples.value();
  reading.invalid = counters.xbus.checksum_errors.value() + counters.xbus.length_errors.value() +
                    counters.xbus.skipped_bytes.value() / kBytesAMessage +
                    counters.error_messages.value() + counters.truncated_payloads.value() +
                    counters.wrong_item_sizes.value() + counters.without_inertial.value();
  reading.lost = counters.lost_messages.value();
  return reading;
}

// Frames of other devices are none of our business: a bus is shared.
SourceReading reading_of(const can::CanImuCounters& counters) noexcept {
  SourceReading reading;
  reading.valid = counters.samples.value();
  reading.invalid = counters.error_frames.value() + counters.short_frames.value() +
                    counters.device_errors.value() + counters.groups_without_inertial.value();
  reading.lost = counters.lost_groups.value();
  return reading;
}

}  // namespace convexcut::daemon
