// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/wire/imu_files.hpp"

#include "drivers/capture/capture_writer.hpp"
#include "replay/atomic_file.hpp"
#include "replay/simulation/random.hpp"
#include "replay/simulation/wire/serial_line.hpp"

namespace convexcut::simulation {

void write_serial_imu(const SerialImuOptions& options, RigStateAt motion, HostTime start,
                      const Period& period, std::uint64_t seed, const std::filesystem::path& pcap) {
  Random noise(seed, kSerialImuStream);
  Random reading(seed, kReadsStream);
  SerialLine line(options.baud);
  send_samples(options, motion, start, period, noise, line);
  capture::CaptureWriter out(pcap, capture::LinkKind::serial);
  for (const SerialRead& read : line.reads(reading)) {
    out.write({.stamp = read.stamp, .kind = capture::RecordKind::serial, .payload = read.bytes});
  }
  out.close();
}

void write_can_imu(const CanImuOptions& options, RigStateAt motion, HostTime start,
                   const Period& period, std::uint64_t seed, const std::filesystem::path& log) {
  Random random(seed, kCanStream);
  replay::AtomicFile out(log);
  out.write(candump_log(options, motion, start, period, random));
  out.commit();
}

}  // namespace convexcut::simulation
