// SPDX-License-Identifier: Apache-2.0
#include "drivers/recording/can_recording.hpp"

namespace convexcut::recording {

CanRecording::CanRecording(const std::filesystem::path& file, const can::BusOptions& options,
                           Sink<ImuSample>& samples, Sink<EncoderSample>& angles)
    : input_(file), tap_(samples), devices_(options, tap_, angles) {}

std::optional<HostTime> CanRecording::next_stamp() {
  if (!have_frame_) have_frame_ = input_.next(frame_);
  if (!have_frame_) return std::nullopt;
  return frame_.stamp;
}

void CanRecording::deliver() {
  ++frames_;
  ++frames_by_id_[frame_.id];
  devices_.on_frame(frame_);
  have_frame_ = false;
}

std::string CanRecording::summary() const {
  return std::to_string(frames_) + " frames, " + input_.malformed();
}

}  // namespace convexcut::recording
