// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <linux/can.h>

#include "drivers/can/can_frame.hpp"
#include "drivers/live/file_descriptor.hpp"

namespace convexcut::socketcan {

// Filters that let exactly the data frames of these identifiers through, no remote frames. The
// kernel takes at most CAN_RAW_FILTER_MAX (512) of them.
[[nodiscard]] std::vector<can_filter> exact_filters(std::span<const can::CanId> ids);

struct OpenedSocket {
  live::FileDescriptor socket;
  int error = 0;  // errno when there is none
};

// A raw, non-blocking socket on `interface` that receives what `filters` let through, classic and
// FD, and the controller's error frames, with stamps and drop counts (live/ancillary.hpp). There
// is none while the interface is missing (ENODEV) or down (ENETDOWN), or when the kernel has no CAN
// (EAFNOSUPPORT). No allocation, no exception.
[[nodiscard]] OpenedSocket open_can_socket(const std::string& interface,
                                           std::span<const can_filter> filters) noexcept;

}  // namespace convexcut::socketcan
