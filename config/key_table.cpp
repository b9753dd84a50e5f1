// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <limits>

#include "config/binding.hpp"
#include "config/schema.hpp"
#include "config/text_rules.hpp"

namespace convexcut::config {
namespace {

constexpr Text kTopic{"a ROS topic name without leading slash (letters, digits, _ and /)",
                      is_topic_name};
constexpr Text kFrame{"a frame name without spaces and leading slash", is_frame_name};
constexpr Text kPath{"a path, or nothing", is_path_or_empty};
constexpr Text kAddress{"an IPv4 address like 192.168.1.201, or nothing", is_ipv4_or_empty};
constexpr Text kGroup{"an IPv4 multicast group, 224.0.0.0 to 239.255.255.255, or nothing",
                      is_multicast_or_empty};
constexpr Text kInterface{"a network interface like eth0, or nothing", is_interface_or_empty};
constexpr Text kListenAddress{"an IPv4 address like 127.0.0.1", is_ipv4};

constexpr Text kCpus{"CPU numbers and ranges like 0,2-3, or nothing", is_cpus_or_empty};

constexpr Number kTurn{-360.0, 360.0};
constexpr Integer kPort{1, 65535};
constexpr Integer kPriority{1, 98};  // 99 is for the kernel's own threads
constexpr Integer kCanId{0, 0x1FFFFFFF, Integer::Notation::hexadecimal};
constexpr std::int64_t kHourInMicroseconds = 3'600'000'000;
constexpr std::int64_t kLastDomain = 232;  // beyond it the ports of DDS do not fit 16 bits

constexpr std::array kSections{
    Section{"lidar", "The lidar: which model, what of it is used, and where scans are cut."},
    Section{"mount", "How the lidar is mounted, where no IMU tells."},
    Section{"imu", "The serial IMU and how it sits on the lidar."},
    Section{"can", "The CAN bus, and the identifiers of the messages of the IMU on it."},
    Section{"encoder", "The angle of a stage that turns the lidar, on the same bus."},
    Section{"convex_cut", "The extraction of structure."},
    Section{"worker", "The grid on which results are made and published."},
    Section{"realtime", "How the threads are kept on time."},
    Section{"dds", "What is published, where and how."},
    Section{"record", "Recording of what the live sources send."},
    Section{"metrics", "Metrics for Prometheus, over HTTP."},
    Section{"log", "The log on standard error."},
};

constexpr std::array kKeys{
    bind_key<&Config::lidar, &Lidar::model>("lidar.model", kChoice<LidarModel>, "",
                                            "The sensor; auto takes it from its packets."),
    bind_key<&Config::lidar, &Lidar::data_port>("lidar.data_port", kPort, "",
                                                "UDP port of the data packets."),
    bind_key<&Config::lidar, &Lidar::position_port>("lidar.position_port", kPort, "",
                                                    "UDP port of the position packets."),
    bind_key<&Config::lidar, &Lidar::source_address>(
        "lidar.source_address", kAddress, "",
        "The sensor's own address: packets of other senders are dropped; empty: any sender."),
    bind_key<&Config::lidar, &Lidar::local_address>(
        "lidar.local_address", kAddress, "",
        "The host's address to listen on; empty: all of them, and broadcasts."),
    bind_key<&Config::lidar, &Lidar::multicast_group>(
        "lidar.multicast_group", kGroup, "",
        "The group that the sensor sends to; empty: it sends to an address or to all."),
    bind_key<&Config::lidar, &Lidar::interface>(
        "lidar.interface", kInterface, "",
        "The network interface that the sensor is on; empty: any."),
    bind_key<&Config::lidar, &Lidar::receive_buffer_kib>(
        "lidar.receive_buffer_kib", Integer{64, 1'048'576}, "KiB",
        "Receive buffer of the data port; 8192 hold packets for seconds."),
    bind_key<&Config::lidar, &Lidar::gather_us>(
        "lidar.gather_us", Integer{0, 5'000}, "µs",
        "Packets that come within this time are taken together: fewer wake-ups; 0: each at once."),
    bind_key<&Config::lidar, &Lidar::min_range_m>("lidar.min_range_m", Number{0.0, 200.0}, "m",
                                                  "Nearer returns are dropped."),
    bind_key<&Config::lidar, &Lidar::max_range_m>("lidar.max_range_m", Number{0.0, 300.0}, "m",
                                                  "Farther returns are dropped."),
    bind_key<&Config::lidar, &Lidar::cut_azimuth>(
        "lidar.cut_azimuth_deg", kTurn, "°",
        "Where one scan ends and the next begins, clockwise from straight ahead."),
    bind_key<&Config::lidar, &Lidar::cut>(
        "lidar.cut", kChoice<CutMode>, "",
        "A scan is a revolution of the sensor, or an exact window of worker.period_ms."),
    bind_key<&Config::lidar, &Lidar::dual_return>(
        "lidar.dual_return", kChoice<DualReturn>, "",
        "Which return of a firing is used when the sensor sends two."),
    bind_key<&Config::lidar, &Lidar::time_offset_us>(
        "lidar.time_offset_us", Integer{-kHourInMicroseconds, kHourInMicroseconds}, "µs",
        "Added to every time of the lidar."),
    bind_key<&Config::lidar, &Lidar::vertical_offsets>(
        "lidar.vertical_offsets", Boolean{}, "",
        "Whether each beam starts at its own height (HDL-32E, VLP-16) and not in the origin."),

    bind_key<&Config::mount, &Mount::orientation>(
        "mount.orientation", kChoice<MountOrientation>, "",
        "What levels the points: the IMU, or the fixed angles below."),
    bind_key<&Config::mount, &Mount::roll>("mount.roll_deg", kTurn, "°",
                                           "Fixed mount: level from lidar, about x."),
    bind_key<&Config::mount, &Mount::pitch>("mount.pitch_deg", kTurn, "°",
                                            "Fixed mount: level from lidar, about y."),
    bind_key<&Config::mount, &Mount::yaw>("mount.yaw_deg", kTurn, "°",
                                          "Fixed mount: level from lidar, about z."),

    bind_key<&Config::imu, &Imu::mount_roll>("imu.mount_roll_deg", kTurn, "°",
                                             "The IMU on the lidar: imu from lidar, about x."),
    bind_key<&Config::imu, &Imu::mount_pitch>("imu.mount_pitch_deg", kTurn, "°",
                                              "The IMU on the lidar: imu from lidar, about y."),
    bind_key<&Config::imu, &Imu::mount_yaw>("imu.mount_yaw_deg", kTurn, "°",
                                            "The IMU on the lidar: imu from lidar, about z."),
    bind_key<&Config::imu, &Imu::max_age_ms>(
        "imu.max_age_ms", Integer{1, 10'000}, "ms",
        "How long an orientation is held, or interpolated over, when samples are missing."),
    bind_key<&Config::imu, &Imu::device>(
        "imu.device", kPath, "",
        "Serial device of the live IMU, best one of /dev/serial/by-id; empty: none."),
    bind_key<&Config::imu, &Imu::baud>(
        "imu.baud", Integer{0, 4'000'000}, "bit/s",
        "Rate of the serial line, which gives the time its bytes take; 0: no line (USB)."),
    bind_key<&Config::imu, &Imu::configure>(
        "imu.configure", Boolean{}, "",
        "Whether the live IMU is told what to send; if not, what it sends is taken."),
    bind_key<&Config::imu, &Imu::rate_hz>(
        "imu.rate_hz", Integer{1, 400}, "Hz",
        "Samples per second of an IMU that is configured: a divisor of 400."),
    bind_key<&Config::imu, &Imu::set_baud>(
        "imu.set_baud", Integer{0, 4'000'000}, "bit/s",
        "Rate that the line of an IMU is set to when it is configured; 0: left as it is."),
    bind_key<&Config::imu, &Imu::scan_baud>(
        "imu.scan_baud", Boolean{}, "",
        "Whether an IMU to be configured that does not answer is tried at other rates."),

    bind_key<&Config::can, &Can::interface>(
        "can.interface", kInterface, "",
        "The network interface of the live bus, like can0; empty: none."),
    bind_key<&Config::can, &Can::bitrate>("can.bitrate", Integer{5'000, 1'000'000}, "bit/s",
                                          "Rate of the bus, which gives the time a frame takes."),
    bind_key<&Config::can, &Can::sample_time_id>("can.sample_time_id", kCanId, "",
                                                 "Identifier of SampleTime."),
    bind_key<&Config::can, &Can::group_counter_id>("can.group_counter_id", kCanId, "",
                                                   "Identifier of GroupCounter."),
    bind_key<&Config::can, &Can::status_id>("can.status_id", kCanId, "",
                                            "Identifier of StatusWord."),
    bind_key<&Config::can, &Can::quaternion_id>("can.quaternion_id", kCanId, "",
                                                "Identifier of Quaternion."),
    bind_key<&Config::can, &Can::euler_id>("can.euler_id", kCanId, "",
                                           "Identifier of EulerAngles."),
    bind_key<&Config::can, &Can::rate_of_turn_id>("can.rate_of_turn_id", kCanId, "",
                                                  "Identifier of RateOfTurn."),
    bind_key<&Config::can, &Can::acceleration_id>("can.acceleration_id", kCanId, "",
                                                  "Identifier of Acceleration."),
    bind_key<&Config::can, &Can::extended_ids>(
        "can.extended_ids", Boolean{}, "",
        "Whether the identifiers are extended ones (29 bits) and not standard (11 bits)."),

    bind_key<&Config::encoder, &Encoder::use>(
        "encoder.use", kChoice<EncoderUse>, "",
        "Whether the angle replaces the heading of the IMU, or with the fixed mount all of it."),
    bind_key<&Config::encoder, &Encoder::axis>(
        "encoder.axis", kChoice<EncoderAxis>, "",
        "What the stage turns the lidar about: its z axis (rotation) or its y axis (tilt)."),
    bind_key<&Config::encoder, &Encoder::preset>(
        "encoder.preset", kChoice<EncoderPreset>, "",
        "A known layout instead of the one below: the position of a CiA 402 drive, behind the "
        "statusword in a PDO, or in answers to SDO uploads of others."),
    bind_key<&Config::encoder, &Encoder::id>("encoder.id", kCanId, "",
                                             "Identifier of the encoder's message."),
    bind_key<&Config::encoder, &Encoder::extended_id>(
        "encoder.extended_id", Boolean{}, "",
        "Whether the identifier is an extended one (29 bits) and not standard (11 bits)."),
    bind_key<&Config::encoder, &Encoder::byte_order>(
        "encoder.byte_order", kChoice<ByteOrder>, "",
        "Least significant byte first (intel) or most significant byte first (motorola)."),
    bind_key<&Config::encoder, &Encoder::start_bit>(
        "encoder.start_bit", Integer{0, 511}, "",
        "Bit n % 8 of byte n / 8: the least significant bit of an intel count, the most "
        "significant "
        "one of a motorola count."),
    bind_key<&Config::encoder, &Encoder::length_bits>("encoder.length_bits", Integer{1, 64}, "",
                                                      "Bits of the count."),
    bind_key<&Config::encoder, &Encoder::is_signed>("encoder.signed", Boolean{}, "",
                                                    "Whether the count can be negative."),
    bind_key<&Config::encoder, &Encoder::scale_deg>(
        "encoder.scale_deg", kTurn, "°",
        "Angle of one count: 360 / counts of a turn / gear; negative: it counts the other way."),
    bind_key<&Config::encoder, &Encoder::offset>("encoder.offset_deg", kTurn, "°",
                                                 "Added to the angle: its value at count 0."),
    bind_key<&Config::encoder, &Encoder::timeout_ms>(
        "encoder.timeout_ms", Integer{1, 10'000}, "ms",
        "How long an angle is held, or interpolated over, when messages are missing."),

    bind_key<&Config::convex_cut, &ConvexCut::method>(
        "convex_cut.method", kChoice<Method>, "",
        "The method; paper is the published one, robust looks at several revolutions."),
    bind_key<&Config::convex_cut, &ConvexCut::planes>(
        "convex_cut.planes", Integer{1, 36'000}, "",
        "Vertical slicing planes over half a turn: 360 are 0.5° apart."),
    bind_key<&Config::convex_cut, &ConvexCut::half_width_m>(
        "convex_cut.half_width_m", Number{0.001, 10.0}, "m",
        "A point belongs to a slice when it is nearer to its plane than this."),
    bind_key<&Config::convex_cut, &ConvexCut::hull_distance_m>(
        "convex_cut.hull_distance_m", Number{0.0, 100.0}, "m",
        "A point is structure when it is at most this far from its slice's hull."),
    bind_key<&Config::convex_cut, &ConvexCut::window>(
        "convex_cut.window", Integer{1, 100}, "revolutions",
        "Robust: the last revolutions that decide together."),
    bind_key<&Config::convex_cut, &ConvexCut::band_m>(
        "convex_cut.band_m", Number{0.001, 0.2}, "m",
        "Robust: a point is structure at most this far before an accepted surface; behind it, at "
        "most 0.08 m or this."),
    bind_key<&Config::convex_cut, &ConvexCut::learn_first>(
        "convex_cut.learn_first", Boolean{}, "",
        "Robust: whether labels wait until their revolution is learnt from: a little better, and "
        "later by 4 ms in a room, by 16 ms in a hall."),
    bind_key<&Config::convex_cut, &ConvexCut::threads>("convex_cut.threads", Integer{1, 64}, "",
                                                       "Threads that share the work."),
    bind_key<&Config::convex_cut, &ConvexCut::simd>(
        "convex_cut.simd", kChoice<SimdPath>, "",
        "The instruction set to compute with; auto takes the best that the processor has."),

    bind_key<&Config::worker, &Worker::period_ms>(
        "worker.period_ms", Integer{10, 1'000}, "ms",
        "A result is made and published once in this time."),
    bind_key<&Config::worker, &Worker::latency_ms>(
        "worker.latency_ms", Integer{1, 1'000}, "ms",
        "Constant time from a scan's last firing to its publication."),
    bind_key<&Config::worker, &Worker::reduce_effort>(
        "worker.reduce_effort", Boolean{}, "",
        "Whether less is computed (fewer planes, then fewer points) when results would be late."),

    bind_key<&Config::realtime, &RealtimeSettings::enabled>(
        "realtime.enabled", kChoice<Realtime>, "",
        "Realtime scheduling: where it is permitted, on (or the start fails), or off."),
    bind_key<&Config::realtime, &RealtimeSettings::receive_priority>(
        "realtime.receive_priority", kPriority, "",
        "SCHED_FIFO priority of the threads that receive."),
    bind_key<&Config::realtime, &RealtimeSettings::worker_priority>(
        "realtime.worker_priority", kPriority, "", "SCHED_FIFO priority of the worker."),
    bind_key<&Config::realtime, &RealtimeSettings::publish_priority>(
        "realtime.publish_priority", kPriority, "",
        "SCHED_FIFO priority of the threads that publish."),
    bind_key<&Config::realtime, &RealtimeSettings::receive_cpus>(
        "realtime.receive_cpus", kCpus, "", "CPUs of the threads that receive; empty: all."),
    bind_key<&Config::realtime, &RealtimeSettings::worker_cpus>("realtime.worker_cpus", kCpus, "",
                                                                "CPUs of the worker; empty: all."),
    bind_key<&Config::realtime, &RealtimeSettings::publish_cpus>(
        "realtime.publish_cpus", kCpus, "", "CPUs of the threads that publish; empty: all."),
    bind_key<&Config::realtime, &RealtimeSettings::lock_memory>(
        "realtime.lock_memory", Boolean{}, "",
        "Whether all memory is locked, so that no page of it has to be fetched again."),

    bind_key<&Config::dds, &Dds::domain>("dds.domain", Integer{0, kLastDomain}, "",
                                         "DDS domain: ROS_DOMAIN_ID of the subscribers."),
    bind_key<&Config::dds, &Dds::profile>(
        "dds.profile", kPath, "", "Cyclone DDS configuration (XML file); empty: the built-in one."),
    bind_key<&Config::dds, &Dds::structure_topic>("dds.structure_topic", kTopic, "",
                                                  "Topic of the structure points."),
    bind_key<&Config::dds, &Dds::points_topic>("dds.points_topic", kTopic, "",
                                               "Topic of all points with their labels."),
    bind_key<&Config::dds, &Dds::imu_topic>("dds.imu_topic", kTopic, "",
                                            "Topic of the IMU samples."),
    bind_key<&Config::dds, &Dds::level_frame>("dds.level_frame", kFrame, "",
                                              "Name of the levelled frame, which points are in."),
    bind_key<&Config::dds, &Dds::imu_frame>("dds.imu_frame", kFrame, "",
                                            "Name of the IMU's frame."),
    bind_key<&Config::dds, &Dds::reliability>(
        "dds.reliability", kChoice<Reliability>, "",
        "Of the point topics; best_effort is not received by reliable subscribers."),
    bind_key<&Config::dds, &Dds::max_blocking_ms>(
        "dds.max_blocking_ms", Integer{1, 10'000}, "ms",
        "How long a reliable write may wait for slow subscribers before it is given up."),

    bind_key<&Config::record, &Record::directory>(
        "record.directory", kPath, "",
        "Directory for lidar_000.pcap, imu_000.pcap, can_000.pcap …; empty: nothing is recorded."),
    bind_key<&Config::record, &Record::max_file_mb>(
        "record.max_file_mb", Integer{0, 1'000'000}, "MB",
        "A file of about this size is ended and the next begun; 0: of any size."),
    bind_key<&Config::record, &Record::max_file_s>(
        "record.max_file_s", Integer{0, 1'000'000}, "s",
        "A file that covers this time is ended and the next begun; 0: any time."),
    bind_key<&Config::record, &Record::keep_mb>(
        "record.keep_mb", Integer{0, 1'000'000'000}, "MB",
        "The oldest files are deleted beyond this, and none gets larger than a quarter of it; 0: "
        "none is."),

    bind_key<&Config::metrics, &Metrics::address>(
        "metrics.address", kListenAddress, "",
        "The host's address on which metrics are served; 0.0.0.0: all of them."),
    bind_key<&Config::metrics, &Metrics::port>("metrics.port", Integer{0, 65535}, "",
                                               "TCP port of http://ADDRESS:PORT/metrics; 0: none."),

    bind_key<&Config::log, &Log::level>("log.level", kChoice<LogLevel>, "",
                                        "The least severe messages to write."),
};

}  // namespace

std::span<const Key> keys() noexcept { return kKeys; }
std::span<const Section> sections() noexcept { return kSections; }

}  // namespace convexcut::config
