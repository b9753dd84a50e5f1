// SPDX-License-Identifier: Apache-2.0
#include "replay/evaluation/result_reader.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "replay/text.hpp"

namespace convexcut::evaluation {
namespace {

constexpr std::string_view kHeader = "index,stamp_ns,points,structure,coverage,latency_us";
constexpr std::size_t kColumns = 6;

// All columns are numbers; those that are needed are read.
[[nodiscard]] std::optional<ResultScan> parse_row(std::string_view row) {
  std::array<std::string_view, kColumns> columns;
  for (std::size_t i = 0; i < kColumns; ++i) {
    const std::size_t comma = row.find(',');
    const bool last = i + 1 == kColumns;
    if ((comma == std::string_view::npos) != last) return std::nullopt;
    columns[i] = row.substr(0, comma);
    if (!last) row.remove_prefix(comma + 1);
  }
  const auto number = [](std::string_view text, auto& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size();
  };
  ResultScan scan;
  std::int64_t stamp_ns = 0;
  const bool good = number(columns[0], scan.index) && number(columns[1], stamp_ns) &&
                    number(columns[2], scan.points) && number(columns[4], scan.coverage);
  if (!good) return std::nullopt;
  scan.stamp = from_ns<HostTime>(stamp_ns);
  return scan;
}

}  // namespace

ResultReader::ResultReader(std::filesystem::path folder) : folder_(std::move(folder)) {
  const std::filesystem::path csv = folder_ / "scans.csv";
  std::ifstream in(csv);
  if (!in) {
    throw std::runtime_error("cannot open " + csv.string() + ": " + std::strerror(errno) +
                             "; expected the folder that `convexcut process --out` wrote");
  }
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    const auto wrong = [&](std::string_view expected) {
      return std::runtime_error(csv.string() + ":" + std::to_string(number) + ": expected " +
                                std::string(expected));
    };
    if (number == 1) {
      if (line != kHeader) throw wrong("the header " + std::string(kHeader));
      continue;
    }
    const auto scan = parse_row(line);
    if (!scan) throw wrong("numbers for " + std::string(kHeader));
    scans_.push_back(*scan);
  }
  if (scans_.empty()) {
    throw std::runtime_error(csv.string() + ": no scan in it: expected at least one");
  }
  if (!std::filesystem::exists(path_of(scans_.front(), "pcd"))) {
    for (const char* other : {"ply", "csv"}) {
      if (!std::filesystem::exists(path_of(scans_.front(), other))) continue;
      throw std::runtime_error(folder_.string() + ": its scans are " + other +
                               " files: expected those of `convexcut process --format pcd`");
    }
  }
}

std::filesystem::path ResultReader::path_of(const ResultScan& scan, const char* extension) const {
  return folder_ /
         replay::format("scan_%06llu.%s", static_cast<unsigned long long>(scan.index), extension);
}

replay::PcdCloud ResultReader::read(const ResultScan& scan) const {
  const std::filesystem::path file = path_of(scan, "pcd");
  replay::PcdCloud cloud = replay::read_pcd(file);
  const std::size_t points = cloud.x.size();
  const auto fail = [&file](const std::string& what) {
    return std::runtime_error(file.string() + ": " + what);
  };
  if (points != scan.points) {
    throw fail("expected " + std::to_string(scan.points) + " points as in scans.csv, found " +
               std::to_string(points));
  }
  if (cloud.label.size() != points) throw fail("not labelled: expected a field label");
  if (cloud.ring.size() != points || cloud.time_ns.size() != points) {
    throw fail("expected the fields ring and time, as `convexcut process` writes them");
  }
  return cloud;
}

}  // namespace convexcut::evaluation
