// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stdexcept>

namespace convexcut::capture {

// A file that cannot be opened, read or written. what() is one line and names the file.
class CaptureError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// How a step through a file ended.
enum class ReadStatus : std::uint8_t {
  record,     // there is one more
  end,        // the file was read to its regular end
  truncated,  // the file stops inside a record; everything before it was delivered
  failed,     // the rest cannot be read: damaged, or the device failed
};

}  // namespace convexcut::capture
