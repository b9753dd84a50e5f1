// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace convexcut::replay {

// A folder that appears under its final name only when all of it is there: its files are made in
// NAME.part, which commit() renames, and which is removed with all that is in it when it is
// destroyed before that.
class StagedFolder {
 public:
  // Throws command_line::UsageError when the name is taken (by anything but an empty folder) or the
  // remains of an interrupted run are in the way, std::runtime_error when it cannot be made; one
  // line.
  explicit StagedFolder(std::filesystem::path name);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  // Where its files are made.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return part_; }

  // Throws std::runtime_error of one line.
  void commit();

 private:
  std::filesystem::path name_;
  std::filesystem::path part_;
  bool committed_ = false;
};

}  // namespace convexcut::replay
