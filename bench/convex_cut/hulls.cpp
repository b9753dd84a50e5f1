// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <string>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/convex_hull_2.h>

#include "bench/convex_cut/literal.hpp"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace convexcut::bench {
namespace {

constexpr std::size_t kLeastPoints = 4;  // Qhull's: dimension + 1, and one to spare

// Qhull's C interface keeps everything in a qhT; the vertices come in no order, the facets of a
// plane hull each name two of them.
class Qhull {
 public:
  explicit Qhull(std::span<const SlicePoint> points) {
    static_assert(sizeof(SlicePoint) == 2 * sizeof(coordT));
    // Qhull reads coordinates without changing them, but its signature does not say so.
    coordinates_.reserve(2 * points.size());
    for (const SlicePoint& point : points) {
      coordinates_.push_back(point.u);
      coordinates_.push_back(point.z);
    }
    qh_zero(&qh_, stderr);
    std::string options = "qhull Pp";
    failed_ = qh_new_qhull(&qh_, 2, static_cast<int>(points.size()), coordinates_.data(), False,
                           options.data(), nullptr, stderr) != 0;
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;
  ~Qhull() {
    qh_freeqhull(&qh_, !qh_ALL);
    int long_left = 0;
    int bytes_left = 0;
    qh_memfreeshort(&qh_, &long_left, &bytes_left);
  }

  [[nodiscard]] std::vector<SlicePoint> vertices() {
    std::vector<SlicePoint> result;
    if (failed_) return result;
    for (const vertexT* v = qh_.vertex_list; v != nullptr && v->next != nullptr; v = v->next) {
      result.push_back({v->point[0], v->point[1]});
    }
    return result;
  }

 private:
  std::vector<coordT> coordinates_;
  qhT qh_{};
  bool failed_ = false;
};

// Around their centre: the vertices of a convex polygon, counter-clockwise.
void order_around_centre(std::vector<SlicePoint>& vertices) {
  SlicePoint centre{};
  for (const SlicePoint& v : vertices) {
    centre.u += v.u / static_cast<double>(vertices.size());
    centre.z += v.z / static_cast<double>(vertices.size());
  }
  std::ranges::sort(vertices, {}, [&](const SlicePoint& v) {
    return std::atan2(v.z - centre.z, v.u - centre.u);
  });
}

}  // namespace

std::vector<SlicePoint> hull_by_qhull(std::span<const SlicePoint> points) {
  if (points.size() < kLeastPoints) return {};
  std::vector<SlicePoint> vertices = Qhull(points).vertices();
  order_around_centre(vertices);
  return vertices;
}

std::vector<SlicePoint> hull_by_cgal(std::span<const SlicePoint> points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_2> input;
  input.reserve(points.size());
  for (const SlicePoint& p : points) input.emplace_back(p.u, p.z);
  std::vector<Kernel::Point_2> output;
  CGAL::convex_hull_2(input.begin(), input.end(), std::back_inserter(output));
  std::vector<SlicePoint> vertices;
  vertices.reserve(output.size());
  for (const Kernel::Point_2& p : output) vertices.push_back({p.x(), p.y()});
  return vertices;
}

std::vector<SlicePoint> hull_by_monotone_chain(std::span<const SlicePoint> points) {
  std::vector<SlicePoint> sorted(points.begin(), points.end());
  std::sort(sorted.begin(), sorted.end());
  const auto turns_right = [](const SlicePoint& a, const SlicePoint& b, const SlicePoint& c) {
    return (b.u - a.u) * (c.z - a.z) - (b.z - a.z) * (c.u - a.u) <= 0.0;
  };
  std::vector<SlicePoint> chain;
  const auto extend = [&](const auto& range) {
    const std::size_t start = chain.size();
    for (const SlicePoint& p : range) {
      while (chain.size() >= start + 2 && turns_right(chain[chain.size() - 2], chain.back(), p)) {
        chain.pop_back();
      }
      chain.push_back(p);
    }
    if (!chain.empty()) chain.pop_back();
  };
  extend(sorted);
  std::ranges::reverse(sorted);
  extend(sorted);
  return chain;
}

}  // namespace convexcut::bench
