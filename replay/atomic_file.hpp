// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

namespace convexcut::replay {

// A file that appears under its final name only when it is whole: it is written as NAME.part,
// renamed by commit(), and removed when it is destroyed before that. Throws std::runtime_error, one
// line that names the file and the reason.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path name);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  void write(std::string_view bytes);
  void commit();

 private:
  [[noreturn]] void fail(const char* doing, int error_number) const;

  std::filesystem::path name_;
  std::filesystem::path part_;
  int fd_ = -1;
};

}  // namespace convexcut::replay
