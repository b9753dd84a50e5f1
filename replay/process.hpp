// SPDX-License-Identifier: Apache-2.0
//
// `convexcut process`: a whole recording to labelled scan files, as fast as possible, bit-identical
// on every run and for every number of threads.
#pragma once

#include <filesystem>

#include "config/config.hpp"
#include "daemon/sources/recordings.hpp"
#include "replay/scan_writer.hpp"

namespace convexcut::replay {

struct ProcessOptions {
  daemon::RecordingPaths recordings;
  config::Config config;
  std::filesystem::path out;
  ScanFormat format = ScanFormat::pcd;
  unsigned threads = 0;  // 0: one a core, at most 4
  bool json = false;
};

// Prints a summary on stdout, warnings on stderr. Throws std::runtime_error of one line.
void process(const ProcessOptions& options);

}  // namespace convexcut::replay
