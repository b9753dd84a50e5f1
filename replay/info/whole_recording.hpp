// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "drivers/recording/recorded_stream.hpp"

namespace convexcut::replay {

// Delivers all of a recording, with a progress bar called `what`; a warning on stderr tells what
// was wrong with the file.
void read_whole(recording::RecordedStream& stream, const char* what);

}  // namespace convexcut::replay
