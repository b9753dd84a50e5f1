// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace convexcut::evaluation {

// Text as it may stand in HTML and SVG.
[[nodiscard]] std::string escaped(std::string_view text);

// <img> with the bytes of a PNG in it (RFC 2397, RFC 4648).
[[nodiscard]] std::string inline_png(std::string_view png, std::string_view description);

// Marks of one kind in an SVG plot.
struct PlotSeries {
  std::string name;
  std::string colour;   // as CSS writes it
  bool joined = false;  // by lines, else marks alone
  struct Point {
    double x;
    double y;
    std::string tip;  // shown when one points at it
  };
  std::vector<Point> points{};
};

struct PlotAxis {
  std::string name;
  double low = 0.0;
  double high = 1.0;
};

// A plot as an <svg> element; axes have about five numbers.
[[nodiscard]] std::string svg_plot(const PlotAxis& x, const PlotAxis& y,
                                   const std::vector<PlotSeries>& series);

}  // namespace convexcut::evaluation
