// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "drivers/capture/capture_reader.hpp"
#include "replay/feed/datagram_link.hpp"
#include "replay/feed/feed.hpp"

namespace convexcut::replay {

struct LidarFeedOptions {
  std::filesystem::path file;
  std::uint16_t data_port = 0;
  std::uint16_t position_port = 0;
};

// A recorded lidar: its datagrams, with the times in them as PlayedTime has it. The NMEA sentence
// of position packets stays as it was recorded.
class LidarFeed final : public Feed {
 public:
  // Throws capture::CaptureError.
  LidarFeed(LidarFeedOptions options, DatagramLink& link);

  [[nodiscard]] std::optional<HostTime> next_stamp() override;
  void send(const PlayedTime& time) override;
  void skip() override { have_record_ = false; }
  void rewind() override;
  [[nodiscard]] Duration record_interval() const noexcept override { return packet_interval_; }

  [[nodiscard]] std::uint64_t data_packets() const noexcept { return data_packets_; }
  [[nodiscard]] std::uint64_t position_packets() const noexcept { return position_packets_; }
  // How far the recording has been read, this time.
  [[nodiscard]] std::uint64_t bytes_read() const noexcept { return reader_->bytes_read(); }
  [[nodiscard]] std::uint64_t bytes_total() const noexcept { return reader_->file_size(); }
  // Datagrams of others in the capture: not sent.
  [[nodiscard]] std::uint64_t foreign() const noexcept { return foreign_; }

 private:
  [[nodiscard]] std::uint16_t port_of(const capture::Record& record) const noexcept;
  void move_time(std::size_t offset, const PlayedTime& time);

  LidarFeedOptions options_;
  DatagramLink& link_;
  std::unique_ptr<capture::CaptureReader> reader_;
  capture::Record record_;
  std::uint16_t port_ = 0;
  bool have_record_ = false;
  std::vector<std::byte> payload_;
  std::optional<std::uint32_t> newest_us_;  // past the hour, as recorded
  Duration gained_{};                       // by the sensor's clock since its first packet
  Duration packet_interval_{};              // the least between data packets, by its clock
  std::uint64_t data_packets_ = 0;
  std::uint64_t position_packets_ = 0;
  std::uint64_t foreign_ = 0;
};

}  // namespace convexcut::replay
