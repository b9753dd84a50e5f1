// SPDX-License-Identifier: Apache-2.0
#include "replay/staged_folder.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include <system_error>

#include "daemon/command_line/exit_status.hpp"

namespace convexcut::replay {

namespace fs = std::filesystem;

namespace {

// "out/" names the folder "out".
fs::path without_slash(fs::path name) { return name.has_filename() ? name : name.parent_path(); }

fs::path with_suffix(const fs::path& name) { return fs::path(name).concat(".part"); }

void refuse_what_is_taken(const fs::path& name, const fs::path& part) {
  std::error_code error;
  if (fs::exists(name, error) && !(fs::is_directory(name, error) && fs::is_empty(name, error))) {
    throw command_line::UsageError(name.string() +
                                   ": exists already; expected a new or an empty folder");
  }
  if (fs::exists(part, error)) {
    throw command_line::UsageError(part.string() +
                                   ": is left from a run that was interrupted; remove it");
  }
}

}  // namespace

StagedFolder::StagedFolder(fs::path name)
    : name_(without_slash(std::move(name))), part_(with_suffix(name_)) {
  refuse_what_is_taken(name_, part_);
  std::error_code error;
  fs::create_directories(part_, error);
  if (error) throw std::runtime_error("cannot make " + part_.string() + ": " + error.message());
}

StagedFolder::~StagedFolder() {
  if (committed_) return;
  std::error_code ignored;  // the reason for being here is told already
  fs::remove_all(part_, ignored);
}

void StagedFolder::commit() {
  std::error_code error;
  fs::rename(part_, name_, error);
  if (error) throw std::runtime_error("cannot make " + name_.string() + ": " + error.message());
  committed_ = true;
}

}  // namespace convexcut::replay
