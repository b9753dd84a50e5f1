// SPDX-License-Identifier: Apache-2.0
//
// Builds the hierarchy by the surface area heuristic in bins (Wald, "On fast Construction of
// SAH-based Bounding Volume Hierarchies", 2007), eight children a node.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include "replay/simulation/scene/geometry.hpp"

namespace convexcut::simulation {
namespace {

constexpr std::size_t kBins = 16;
// Below this depth halves are made, whatever they cost: the depth stays under that of the stack.
constexpr int kDeepestBinned = 32;

struct BoundedShape {
  Bounds bounds;
  Vec3 centre;
  std::uint32_t primitive;
};
using Items = std::span<BoundedShape>;

Bounds bounds_of_items(Items items) {
  Bounds bounds;
  for (const BoundedShape& item : items) bounds.add(item.bounds);
  return bounds;
}

struct Split {
  Eigen::Index axis = 0;
  double position = 0.0;
  double cost = kNoHit;
};

// The cheapest of the planes between the bins of one axis.
Split best_split(Items items, const Bounds& centres, Eigen::Index axis) {
  struct Bin {
    Bounds bounds;
    std::size_t count = 0;
    [[nodiscard]] double cost() const {
      if (count == 0) return kNoHit;
      return static_cast<double>(count) * bounds.area();
    }
  };
  const double low = centres.low[axis];
  const double width = (centres.high[axis] - low) / kBins;
  if (width <= 0.0) return {};
  std::array<Bin, kBins> bins;
  for (const BoundedShape& item : items) {
    const double place = std::clamp((item.centre[axis] - low) / width, 0.0, kBins - 0.5);
    Bin& bin = bins[static_cast<std::size_t>(place)];
    bin.bounds.add(item.bounds);
    ++bin.count;
  }
  std::array<double, kBins> cost_above{};
  Bin sum;
  for (std::size_t i = kBins - 1; i > 0; --i) {
    sum.bounds.add(bins[i].bounds);
    sum.count += bins[i].count;
    cost_above[i] = sum.cost();
  }
  Split best;
  sum = {};
  for (std::size_t i = 1; i < kBins; ++i) {
    sum.bounds.add(bins[i - 1].bounds);
    sum.count += bins[i - 1].count;
    const double cost = cost_above[i] + sum.cost();
    if (cost < best.cost) best = {axis, low + width * static_cast<double>(i), cost};
  }
  return best;
}

// Where the second part begins; both have items. At least two items.
std::size_t split(Items items, int depth) {
  Bounds centres;
  for (const BoundedShape& item : items) centres.add(item.centre);
  Split best;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Split found = best_split(items, centres, axis);
    if (found.cost < best.cost) best = found;
  }
  if (best.cost < kNoHit && depth < kDeepestBinned) {
    const auto above = std::partition(items.begin(), items.end(), [&](const BoundedShape& item) {
      return item.centre[best.axis] < best.position;
    });
    const auto first = static_cast<std::size_t>(above - items.begin());
    if (first > 0 && first < items.size()) return first;
  }
  Eigen::Index longest = 0;
  centres.size().maxCoeff(&longest);
  const auto middle = items.begin() + static_cast<std::ptrdiff_t>(items.size() / 2);
  std::nth_element(items.begin(), middle, items.end(),
                   [&](const BoundedShape& a, const BoundedShape& b) {
                     return a.centre[longest] < b.centre[longest];
                   });
  return items.size() / 2;
}

// Up to eight parts of which none is empty.
std::vector<Items> parts_of(Items items, int depth) {
  std::vector<Items> parts{items};
  while (parts.size() < EightBoxes::kLanes) {
    const auto largest = std::ranges::max_element(parts, {}, [](Items part) {
      return part.size() == 1 ? -1.0 : bounds_of_items(part).area();
    });
    if (largest->size() == 1) break;
    const std::size_t second = split(*largest, depth);
    const Items whole = *largest;
    *largest = whole.first(second);
    parts.push_back(whole.subspan(second));
  }
  return parts;
}

}  // namespace

class Geometry::Builder {
 public:
  Builder(std::vector<Primitive> primitives, Geometry& geometry)
      : source_(std::move(primitives)), geometry_(geometry) {
    for (std::size_t i = 0; i < source_.size(); ++i) {
      const Bounds bounds = bounds_of(source_[i].shape);
      geometry_.bounds_.add(bounds);
      items_.push_back({bounds, bounds.centre(), static_cast<std::uint32_t>(i)});
    }
    geometry_.primitives_.reserve(source_.size());
    if (!items_.empty()) add_node(items_, 0);
  }

 private:
  std::uint32_t add_primitive(const BoundedShape& item) {
    geometry_.primitives_.push_back(std::move(source_[item.primitive]));
    return static_cast<std::uint32_t>(geometry_.primitives_.size() - 1);
  }

  std::uint32_t add_node(Items items, int depth) {
    const auto index = static_cast<std::uint32_t>(geometry_.nodes_.size());
    geometry_.nodes_.emplace_back();
    const std::vector<Items> parts = parts_of(items, depth);
    for (std::size_t lane = 0; lane < parts.size(); ++lane) {
      const Items part = parts[lane];
      const std::uint32_t child = part.size() == 1 ? add_primitive(part.front())
                                                   : add_node(part, depth + 1) | Node::kIsNode;
      Node& node = geometry_.nodes_[index];
      node.boxes.set(lane, bounds_of_items(part));
      node.children[lane] = child;
    }
    return index;
  }

  std::vector<Primitive> source_;
  std::vector<BoundedShape> items_;
  Geometry& geometry_;
};

Geometry::Geometry(std::vector<Primitive> primitives) { Builder(std::move(primitives), *this); }

}  // namespace convexcut::simulation
