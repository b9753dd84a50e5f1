// SPDX-License-Identifier: Apache-2.0
//
// What texts in the configuration have to look like.
#pragma once

#include <bitset>
#include <cstdint>
#include <optional>
#include <string_view>

namespace convexcut::config {

// A ROS 2 topic name relative to the root: tokens of letters, digits and underscores that do not
// begin with a digit, joined by single slashes; no double underscore; at most 246 characters, with
// the root's slash rmw's limit of 247
// (https://design.ros2.org/articles/topic_and_service_names.html).
[[nodiscard]] bool is_topic_name(std::string_view text) noexcept;

// A tf2 frame: printable, no spaces, no leading slash, at most 255 characters.
[[nodiscard]] bool is_frame_name(std::string_view text) noexcept;

// A path, or nothing: no control characters, at most 4095 characters.
[[nodiscard]] bool is_path_or_empty(std::string_view text) noexcept;

// Dotted decimal, four numbers 0 … 255 without leading zeros: 192.168.1.201 is 0xC0A801C9.
[[nodiscard]] std::optional<std::uint32_t> parse_ipv4(std::string_view text) noexcept;
[[nodiscard]] bool is_ipv4(std::string_view text) noexcept;
[[nodiscard]] bool is_ipv4_or_empty(std::string_view text) noexcept;
// 224.0.0.0 … 239.255.255.255 (RFC 5771).
[[nodiscard]] bool is_multicast_or_empty(std::string_view text) noexcept;

// A Linux network interface: 1 … 15 characters without slash, colon or space, neither "." nor "..".
[[nodiscard]] bool is_interface_or_empty(std::string_view text) noexcept;

// CPU numbers and ranges of them, joined by commas, as taskset and systemd take them: "0,2-3" →
// bits 0, 2 and 3. Numbers 0 … 1023 (the kernel's cpu_set_t), ranges that do not fall.
using CpuSet = std::bitset<1024>;
[[nodiscard]] std::optional<CpuSet> parse_cpus(std::string_view text) noexcept;
[[nodiscard]] bool is_cpus_or_empty(std::string_view text) noexcept;

}  // namespace convexcut::config
