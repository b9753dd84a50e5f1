// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/convex_cut/fuzzed_cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/convex_cut/engine.hpp"
#include "core/convex_cut/reference.hpp"
#include "core/convex_cut/slicing_plane.hpp"
#include "core/convex_cut/streaming_cut.hpp"
#include "core/simd/simd_path.hpp"

namespace convexcut::test {
namespace {

constexpr std::array<std::uint32_t, 8> kPlanes{1, 2, 3, 4, 7, 12, 16, 45};
constexpr std::array<double, 8> kHalfWidths{0.05, 0.02, 0.1, 0.25, 1.0, 2.0, 1e-4, 1e-6};
constexpr std::array<double, 8> kHullDistances{0.08, 0.05, 0.0, 0.25, 1.0, 50.0, 1e-3, 1e-7};
// Powers of two: the angles of fewer planes then are those of every so manyth, bit by bit.
constexpr std::array<std::uint32_t, 4> kStrides{1, 1, 2, 4};
constexpr std::array<double, 8> kScales{1e-2, 1e-3, 1e-1, 1.0, 1e-5, 7.0, 1e-9, 30.0};

// Zeros when the bytes have come to their end.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  [[nodiscard]] bool at_end() const { return bytes_.empty(); }
  [[nodiscard]] std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t first = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return first;
  }
  [[nodiscard]] double number() {
    const unsigned low = byte();
    return static_cast<std::int16_t>(low | static_cast<unsigned>(byte()) << 8U);
  }
  template <class Table>
  [[nodiscard]] typename Table::value_type one_of(const Table& table) {
    return table[byte() % table.size()];
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

class Builder {
 public:
  explicit Builder(std::span<const std::uint8_t> bytes) : read_(bytes) {
    made_.parameters.planes = read_.one_of(kPlanes);
    made_.parameters.half_width_m = read_.one_of(kHalfWidths);
    made_.parameters.hull_distance_m = read_.one_of(kHullDistances);
    scale_ = read_.one_of(kScales);
    made_.plane_stride = read_.one_of(kStrides);
  }

  [[nodiscard]] FuzzedCloud build() {
    constexpr std::array kShapes{&Builder::point,      &Builder::line,   &Builder::copies,
                                 &Builder::slice_edge, &Builder::chord,  &Builder::circle,
                                 &Builder::lattice,    &Builder::mirror, &Builder::scatter,
                                 &Builder::rescale};
    // Small clouds are tried more often in the same time; large ones have more candidates for a
    // hull.
    most_ = read_.byte() % 8U == 0 ? kMaxFuzzedPoints : kMaxFuzzedPoints / 6;
    while (!read_.at_end() && made_.cloud.size() < most_) {
      (this->*kShapes[read_.byte() % kShapes.size()])();
    }
    return std::move(made_);
  }

 private:
  void add(double x, double y, double z) {
    const double greatest = std::max({std::abs(x), std::abs(y), std::abs(z)});
    if (made_.cloud.size() < most_ && greatest <= static_cast<double>(kMaxCoordinateM)) {
      made_.cloud.add(x, y, z);
    }
  }
  [[nodiscard]] std::size_t count() { return read_.byte() % 64U + 1U; }
  [[nodiscard]] double length() { return read_.number() * scale_; }
  // One of the points so far.
  [[nodiscard]] std::array<double, 3> earlier() {
    const Cloud& cloud = made_.cloud;
    const std::size_t back = read_.byte();
    if (cloud.size() == 0) return {};
    const std::size_t i = cloud.size() - 1 - std::min(back, cloud.size() - 1);
    return {static_cast<double>(cloud.x[i]), static_cast<double>(cloud.y[i]),
            static_cast<double>(cloud.z[i])};
  }

  void point() {
    const double x = length();
    const double y = length();
    add(x, y, length());
  }
  // Collinear, up to the rounding to float.
  void line() {
    const auto [x, y, z] = earlier();
    const double dx = length();
    const double dy = length();
    const double dz = length();
    const std::size_t points = count();
    for (std::size_t i = 1; i <= points; ++i) {
      const auto k = static_cast<double>(i);
      add(x + k * dx, y + k * dy, z + k * dz);
    }
  }
  void copies() {
    const auto [x, y, z] = earlier();
    const std::size_t points = count();
    for (std::size_t i = 0; i < points; ++i) add(x, y, z);
  }
  // As near to |v| = d of some plane as a float can be, and its neighbours.
  void slice_edge() {
    const ConvexCutParameters& p = made_.parameters;
    const SlicingPlane plane = slicing_plane(read_.byte() % p.planes, p.planes);
    const double v = read_.byte() % 2U == 0 ? p.half_width_m : -p.half_width_m;
    const double u = length();
    const double z = length();
    const double x = u * plane.cos_theta - v * plane.sin_theta;
    const double y = u * plane.sin_theta + v * plane.cos_theta;
    add(x, y, z);
    for (const float to : {-INFINITY, INFINITY}) {
      add(static_cast<double>(std::nextafter(static_cast<float>(x), to)), y, z);
      add(x, static_cast<double>(std::nextafter(static_cast<float>(y), to)), z);
    }
  }
  // Points along the way from one point to another, and at the hull distance from it.
  void chord() {
    const auto [ax, ay, az] = earlier();
    const auto [bx, by, bz] = earlier();
    const double share = read_.byte() / 255.0;
    const double x = ax + share * (bx - ax);
    const double y = ay + share * (by - ay);
    const double z = az + share * (bz - az);
    const double e = made_.parameters.hull_distance_m;
    add(x, y, z);
    add(x, y, z + e);
    add(x, y, z - e);
    const double across = std::hypot(bx - ax, by - ay);
    const double along = std::hypot(across, bz - az);
    if (along == 0.0 || across == 0.0) return;
    const double out = -(bz - az) / along * e / across;
    add(x + out * (bx - ax), y + out * (by - ay), z + across / along * e);
  }
  // All of them vertices of a slice's hull.
  void circle() {
    const auto [x, y, z] = earlier();
    const double radius = length();
    const double theta = std::numbers::pi * read_.byte() / 128.0;
    const std::size_t points = count();
    for (std::size_t i = 0; i < points; ++i) {
      const double phi =
          2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(points);
      const double u = radius * std::cos(phi);
      add(x + u * std::cos(theta), y + u * std::sin(theta), z + radius * std::sin(phi));
    }
  }
  void lattice() {
    const auto [x, y, z] = earlier();
    const double step = length();
    const std::size_t side = read_.byte() % 6U + 1U;
    for (std::size_t i = 0; i < side * side * side; ++i) {
      add(x + step * static_cast<double>(i % side), y + step * static_cast<double>(i / side % side),
          z + step * static_cast<double>(i / side / side));
    }
  }
  void mirror() {
    const std::size_t points = std::min(count(), made_.cloud.size());
    for (std::size_t i = 0; i < points; ++i) {
      const Cloud& cloud = made_.cloud;
      const std::size_t k = cloud.size() - 1 - i;
      add(-static_cast<double>(cloud.x[k]), -static_cast<double>(cloud.y[k]),
          static_cast<double>(cloud.z[k]));
    }
  }
  void scatter() {
    Random random(read_.byte());
    const double size = std::abs(length());
    const std::size_t points = 8 * count();
    for (std::size_t i = 0; i < points; ++i) {
      add(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
    }
  }
  void rescale() { scale_ = read_.one_of(kScales); }

  Reader read_;
  FuzzedCloud made_;
  double scale_ = 1.0;
  std::size_t most_ = 0;
};

// Every plane_stride-th plane is Convex Cut with that many planes less, where it divides them.
[[nodiscard]] std::vector<Label> expected_labels(const FuzzedCloud& input) {
  ConvexCutParameters parameters = input.parameters;
  if (parameters.planes % input.plane_stride == 0) parameters.planes /= input.plane_stride;
  std::vector<Label> labels(input.cloud.size());
  static_cast<void>(reference::label(parameters, input.cloud.view(), labels));
  return labels;
}

// In two pieces at a quarter's and a half's end, then the rest: some slices are done early, and
// again.
[[nodiscard]] bool streaming_differs(const FuzzedCloud& input, const std::vector<Label>& expected) {
  const CloudView all = input.cloud.view();
  StreamingCut cut(input.parameters, all.size());
  cut.begin();
  for (const std::size_t end : {all.size() / 4, all.size() / 2}) {
    if (cut.add({all.x.first(end), all.y.first(end), all.z.first(end)}) != CutStatus::ok)
      return true;
  }
  std::vector<Label> labels(all.size(), Label::structure);
  return cut.finish(all, labels) != CutStatus::ok || labels != expected;
}

}  // namespace

FuzzedCloud fuzzed_cloud(std::span<const std::uint8_t> bytes) { return Builder(bytes).build(); }

std::string_view differing_path(const FuzzedCloud& input) {
  const std::vector<Label> expected = expected_labels(input);
  const std::uint32_t stride =
      input.parameters.planes % input.plane_stride == 0 ? input.plane_stride : 1;
  static const std::vector<std::string_view> paths = simd_paths();
  // Starting threads costs more than all the rest, as does streaming.
  const bool with_two = input.cloud.size() % 32 == 0;
  const bool with_streaming = stride == 1 && input.cloud.size() % 4 == 1;
  std::string_view differs;
  for (const unsigned threads : {1U, 2U}) {
    if (threads == 2 && !with_two) break;
    ConvexCutEngine engine(input.parameters, input.cloud.size(), threads);
    for (const std::string_view path : paths) {
      if (!use_simd_path(path)) return path;
      std::vector<Label> labels(input.cloud.size(), Label::structure);
      const CutStatus status = engine.label(input.cloud.view(), labels, stride);
      if (status != CutStatus::ok || labels != expected) differs = path;
    }
  }
  static_cast<void>(use_simd_path("auto"));
  if (with_streaming && streaming_differs(input, expected)) return "streaming";
  return differs;
}

}  // namespace convexcut::test
