// SPDX-License-Identifier: Apache-2.0
#include "replay/info/whole_recording.hpp"

#include <cstdio>
#include <string>

#include "replay/progress_bar.hpp"

namespace convexcut::replay {

void read_whole(recording::RecordedStream& stream, const char* what) {
  {
    ProgressBar bar(what);
    while (stream.next_stamp()) {
      stream.deliver();
      bar.update(stream.bytes_read(), stream.bytes_total());
    }
    stream.finish();
  }
  if (const std::string problem = stream.problem(); !problem.empty()) {
    std::fprintf(stderr, "warning: %s\n", problem.c_str());
  }
}

}  // namespace convexcut::replay
