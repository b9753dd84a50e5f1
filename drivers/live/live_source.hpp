// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/time.hpp"

namespace convexcut::live {

// What a source's device can say of itself, without regard to what the bytes mean.
enum class LinkState : std::uint8_t {
  closed,  // not there, or not to be opened: cable out, interface down, port in use
  open,    // readable; whether anything comes is another matter
  error,   // there, and reporting errors of its own: bus-off
};

// A live byte source on its way into a driver: what one receive thread runs. The recordings deliver
// to the same drivers (drivers/recording/); only where the bytes come from differs.
//
// Thread: receive() on one thread; the rest from any. RT: no allocation, no lock, no exception, no
// text; while the link is open the only blocking call is the wait for input.
class LiveSource {
 public:
  LiveSource() = default;
  LiveSource(const LiveSource&) = delete;
  LiveSource& operator=(const LiveSource&) = delete;
  virtual ~LiveSource() = default;

  // Waits for input no longer than `wait`, and hands what has come to the driver. A closed link is
  // opened again, at most a few times a second.
  virtual void receive(Duration wait) noexcept = 0;

  [[nodiscard]] virtual LinkState link() const noexcept = 0;
  // errno of the newest failure to open or read; 0: none since the link is open.
  [[nodiscard]] virtual int last_error() const noexcept = 0;
};

}  // namespace convexcut::live
