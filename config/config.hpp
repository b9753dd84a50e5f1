// SPDX-License-Identifier: Apache-2.0
//
// The whole configuration as typed values with their defaults. The schema (config/schema.cpp) binds
// every field to its TOML key, range and description.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "core/angle.hpp"
#include "core/time.hpp"

namespace convexcut::config {

enum class LidarModel : std::uint8_t { automatic, hdl32e, vlp16, puck_hires, vlp32c };
enum class CutMode : std::uint8_t { revolution, clock };
enum class DualReturn : std::uint8_t { farthest, last, strongest, both };
enum class MountOrientation : std::uint8_t { imu, fixed };
enum class EncoderUse : std::uint8_t { off, yaw, orientation };
enum class EncoderAxis : std::uint8_t { rotation, tilt };
enum class EncoderPreset : std::uint8_t { none, cia402_position, cia402_position_sdo };
enum class ByteOrder : std::uint8_t { intel, motorola };
enum class Method : std::uint8_t { paper, robust };
enum class SimdPath : std::uint8_t { automatic, avx512, avx2, sse4, neon, baseline };
enum class LogLevel : std::uint8_t { error, warning, info, debug };
enum class Realtime : std::uint8_t { automatic, on, off };
enum class Reliability : std::uint8_t { reliable, best_effort };

struct Lidar {
  LidarModel model = LidarModel::automatic;
  std::uint16_t data_port = 2368;
  std::uint16_t position_port = 8308;
  std::string source_address;   // IPv4 address of the sensor, see parse_ipv4(); empty: any
  std::string local_address;    // IPv4 address that is listened on; empty: all, and broadcasts
  std::string multicast_group;  // IPv4 group that the sensor sends to; empty: none
  std::string interface;        // network interface that is listened on; empty: any
  std::int64_t receive_buffer_kib = 8192;
  std::int64_t gather_us = 1000;  // that packets wait to be taken together
  double min_range_m = 0.5;
  double max_range_m = 100.0;
  Degrees cut_azimuth{0.0};
  CutMode cut = CutMode::revolution;
  DualReturn dual_return = DualReturn::farthest;
  std::int64_t time_offset_us = 0;  // added to every lidar time
  bool vertical_offsets = false;    // per-beam focal-point offsets (HDL-32E, VLP-16)
};

struct Mount {
  MountOrientation orientation = MountOrientation::imu;
  Degrees roll{0.0};  // of the fixed mount: level ← lidar
  Degrees pitch{0.0};
  Degrees yaw{0.0};
};

struct Imu {
  Degrees mount_roll{0.0};  // imu ← lidar
  Degrees mount_pitch{0.0};
  Degrees mount_yaw{0.0};
  std::int64_t max_age_ms = 50;
  std::string device;           // serial device of the live IMU; empty: none
  std::uint32_t baud = 115200;  // the line's rate: the time that the bytes of a frame take
  bool configure = false;       // false: whatever the device sends is taken, nothing is sent to it
  std::uint32_t rate_hz = 400;  // of the samples, where it is configured
  std::uint32_t set_baud = 460800;  // the line's rate after configuration; 0: as it is
  bool scan_baud = false;           // whether other rates are tried when it does not answer
};

struct Can {
  std::string interface;  // network interface of the live bus; empty: none
  std::uint32_t bitrate = 250000;
  std::uint32_t sample_time_id = 0x005;
  std::uint32_t group_counter_id = 0x006;
  std::uint32_t status_id = 0x011;
  std::uint32_t quaternion_id = 0x021;
  std::uint32_t euler_id = 0x022;
  std::uint32_t rate_of_turn_id = 0x032;
  std::uint32_t acceleration_id = 0x034;
  bool extended_ids = false;
};

// The encoder of a stage that turns the lidar, on the same bus as the IMU.
struct Encoder {
  EncoderUse use = EncoderUse::off;
  EncoderAxis axis = EncoderAxis::rotation;
  EncoderPreset preset = EncoderPreset::none;
  std::uint32_t id = 0x181;
  bool extended_id = false;
  ByteOrder byte_order = ByteOrder::intel;
  std::uint32_t start_bit = 0;
  std::uint32_t length_bits = 32;
  bool is_signed = true;
  double scale_deg = 0.001;  // of a count
  Degrees offset{0.0};
  std::int64_t timeout_ms = 100;
};

struct ConvexCut {
  Method method = Method::paper;
  std::uint32_t planes = 360;
  double half_width_m = 0.05;
  double hull_distance_m = 0.08;
  std::uint32_t window = 30;
  double band_m = 0.055;
  bool learn_first = true;
  std::uint32_t threads = 1;
  SimdPath simd = SimdPath::automatic;
};

struct Worker {
  std::int64_t period_ms = 100;
  std::int64_t latency_ms = 10;
  bool reduce_effort = true;
};

struct Dds {
  std::uint32_t domain = 0;
  std::string profile;  // path of a Cyclone DDS XML file; empty: the built-in one
  std::string structure_topic = "convexcut/structure";  // ROS names, without the rt/ of the wire
  std::string points_topic = "convexcut/points";
  std::string imu_topic = "imu/data";
  std::string level_frame = "level";
  std::string imu_frame = "imu";
  Reliability reliability = Reliability::reliable;
  std::int64_t max_blocking_ms = 50;
};

struct RealtimeSettings {
  Realtime enabled = Realtime::automatic;
  std::uint32_t receive_priority = 80;  // SCHED_FIFO, of the threads that receive
  std::uint32_t worker_priority = 70;
  std::uint32_t publish_priority = 60;
  std::string receive_cpus;  // see parse_cpus(); empty: all
  std::string worker_cpus;
  std::string publish_cpus;
  bool lock_memory = true;
};

// What is recorded of live input; see docs/design/recording.md.
struct Record {
  std::string directory;  // empty: nothing is recorded
  std::int64_t max_file_mb = 1024;
  std::int64_t max_file_s = 0;  // 0: no limit
  std::int64_t keep_mb = 0;     // 0: everything
};

struct Metrics {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  // 0: no metrics are served
};

struct Log {
  LogLevel level = LogLevel::info;
};

struct Config {
  Lidar lidar;
  Mount mount;
  Imu imu;
  Can can;
  Encoder encoder;
  ConvexCut convex_cut;
  Worker worker;
  RealtimeSettings realtime;
  Dds dds;
  Record record;
  Metrics metrics;
  Log log;
};

}  // namespace convexcut::config
