// SPDX-License-Identifier: Apache-2.0
//
// The points of a cloud sorted so that the candidates for a slice lie in a few contiguous ranges.
//
// A point at horizontal radius r is within d of a plane through the z axis only if its direction is
// within asin(d/r) of the plane's or of the opposite one. So the points are sorted by shell (a
// range of r) and within a shell by direction: a plane's candidates in a shell are a range on
// either side of the axis, or two where a range passes 360°. Candidates are a superset: the caller
// decides on |v| < d.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/cloud.hpp"
#include "core/convex_cut/cloud_kernels.hpp"
#include "core/convex_cut/column.hpp"
#include "core/convex_cut/slicing_plane.hpp"
#include "core/workspace.hpp"

namespace convexcut {

class ShellIndex {
 public:
  // Shell 0: r < √2·d, whose points are candidates of every plane; shell s: √2ˢ·d ≤ r < √2ˢ⁺¹·d;
  // the last one is open. 24 shells reach 2900·d, beyond which a bucket is wider than any slice.
  static constexpr std::size_t kShells = 24;
  static constexpr std::size_t kBuckets = 2048;  // directions, all round

  // Positions [begin, end) of the sorted points.
  struct Range {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
  };
  // Candidates of a slice: those that are members have u within the bounds, in metres.
  struct Candidates {
    Range range;
    float least_u_m = 0.0F;
    float most_u_m = 0.0F;
  };
  static constexpr std::size_t kMostRanges = 4 * kShells;

  // Allocates 38 bytes a point. threads: that a build is made for.
  ShellIndex(double half_width_m, std::size_t max_points, unsigned threads);

  // Sorts a cloud of at most max_points points whose coordinates have been checked, in the calling
  // thread. RT: no allocation, no lock, no system call.
  void build(const CloudView& cloud) noexcept;

  // The same in steps for several threads: a counting sort. Every call of a step is made once, in
  // any thread, and all of them have returned before the next step begins.
  //  1. begin
  //  2. count(part_number) for each part: sorts nothing yet. Returns the bit pattern of the
  //     greatest magnitude of a coordinate (see greatest_magnitude_bits); when that is beyond
  //     kMaxCoordinateM, the part has not been counted and the build has to be given up.
  //  3. lay_out
  //  4. number_keys(run) for each run
  //  5. place(part) for each part
  //  6. spread(piece) for each piece
  void begin(const CloudView& cloud) noexcept;
  [[nodiscard]] std::uint32_t count(std::size_t part_number) noexcept;
  void lay_out() noexcept;
  void number_keys(std::size_t run) noexcept;
  void place(std::size_t part) noexcept;
  void spread(std::size_t piece) noexcept;
  [[nodiscard]] std::size_t parts() const noexcept { return parts_.size(); }
  // What can be worked on at once, known from lay_out() on: runs of keys, and pieces of the sorted
  // points. In front are those of the two opposite quarter turns that the first and the third
  // quarter of the cloud cover, where it comes from a rotor and there are two parts: in the cache
  // of the thread that has counted and placed them.
  struct Shares {
    std::size_t count = 0;
    std::size_t in_front = 0;  // of these two quarter turns
  };
  [[nodiscard]] const Shares& runs() const noexcept { return run_shares_; }
  [[nodiscard]] const Shares& pieces() const noexcept { return piece_shares_; }
  [[nodiscard]] Range piece(std::size_t k) const noexcept { return pieces_[k]; }
  // Where one of these quarter turns begins: slices of planes from there on lie in them.
  [[nodiscard]] std::size_t front_bucket() const noexcept { return front_strip_ * kStripBuckets; }
  static constexpr std::size_t kChunk = 4096;  // points of a piece, at most

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  // The sorted points, and where each one came from.
  [[nodiscard]] CloudView points() const noexcept {
    return {{x_.data(), size_}, {y_.data(), size_}, {z_.data(), size_}};
  }
  [[nodiscard]] std::uint32_t source(std::size_t position) const noexcept {
    return source_[position];
  }

  // The buckets that a plane's slice touches in one shell, on the side of u > 0: `count` from
  // `first` on, wrapping.
  struct Window {
    std::uint16_t first = 0;
    std::uint16_t count = 0;
  };
  using Windows = std::array<Window, kShells>;
  [[nodiscard]] static Windows windows(const SlicingPlane& plane) noexcept;

  // Calls visit(Candidates) for every range that may hold points of the slice.
  template <class Visit>
  void for_each_candidate_range(const Windows& windows, Visit&& visit) const noexcept {
    for (const std::size_t shell : std::span(used_shells_).first(used_shell_count_)) {
      const std::uint32_t* const start = starts_.data() + shell * kBuckets;
      const float near = least_u_m_[shell];
      const float far = most_u_m_[shell];
      if (shell == 0) {
        visit(Candidates{{start[0], start[kBuckets]}, -far, far});
        continue;
      }
      const auto visit_from = [&](std::size_t first, float least_u_m, float most_u_m) {
        const std::size_t last = first + windows[shell].count;
        const std::size_t wrapped = last > kBuckets ? last - kBuckets : 0;
        const Range range{start[first], start[last - wrapped]};
        if (range.begin != range.end) visit(Candidates{range, least_u_m, most_u_m});
        if (wrapped > 0 && start[0] != start[wrapped]) {
          visit(Candidates{{start[0], start[wrapped]}, least_u_m, most_u_m});
        }
      };
      const std::size_t first = windows[shell].first;
      visit_from(first, near, far);
      visit_from((first + kBuckets / 2) % kBuckets, -far, -near);
    }
  }

 private:
  // Neighbouring buckets of a shell.
  static constexpr std::size_t kStripsOfShell = 32;
  static constexpr std::size_t kStripBuckets = kBuckets / kStripsOfShell;
  static constexpr std::size_t kStrips = kShells * kStripsOfShell;

  struct Part {
    // Its points in the cloud, in opposite directions where a rotor has turned once.
    std::array<Range, 2> points;
    std::vector<std::uint32_t> counts;  // of each key; then the place of the first one
    std::array<std::uint32_t, kStrips> strip_counts{};
    KeyBounds bounds;
  };

  void count_points(Part& part, Range points) noexcept;
  void lay_out_runs(std::size_t least_shell, std::size_t greatest_shell) noexcept;
  void add_run(std::size_t begin, std::size_t end) noexcept;
  void add_pieces(std::uint32_t begin, std::uint32_t end) noexcept;

  float inverse_squared_half_width_;
  std::array<float, kShells> least_u_m_;  // bounds of |u| of members
  std::array<float, kShells> most_u_m_;
  CloudView cloud_;  // the one that is being sorted
  std::size_t size_ = 0;
  std::vector<Part> parts_;
  Workspace<std::uint16_t> keys_;   // shell · kBuckets + bucket, in the cloud's order
  Workspace<std::uint32_t> ranks_;  // of each point among those of its key in the same part
  Column<PointRecord> records_;
  Column<float> x_, y_, z_;
  Column<std::uint32_t> source_;
  std::vector<std::uint32_t> starts_;        // of each key in the sorted points, and the end
  std::vector<std::uint32_t> strip_starts_;  // of each strip, and the end
  std::size_t front_strip_ = 0;
  std::vector<Range> runs_;  // of strips
  Shares run_shares_;
  std::array<std::size_t, kShells> used_shells_{};
  std::size_t used_shell_count_ = 0;
  std::vector<Range> pieces_;
  Shares piece_shares_;
};

}  // namespace convexcut
