// SPDX-License-Identifier: Apache-2.0
//
// Where a driver puts its samples: it claims a slot, fills it in place and commits it. A ring in
// the daemon, the pipeline itself in `convexcut process`: the driver cannot tell.
#pragma once

namespace convexcut {

template <class Sample>
class Sink {
 public:
  Sink() = default;
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;
  virtual ~Sink() = default;

  // A slot to fill, or null when there is no room (the sink has counted the loss). The slot holds
  // the remains of an earlier sample. RT: no allocation, no lock, no system call.
  [[nodiscard]] virtual Sample* claim() noexcept = 0;
  // Hands the claimed slot on. A claim that is not committed is simply claimed again.
  virtual void commit() noexcept = 0;
};

}  // namespace convexcut
