// SPDX-License-Identifier: Apache-2.0
#include "replay/evaluation/html.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "replay/text.hpp"

namespace convexcut::evaluation {
namespace {

using replay::format;

constexpr double kWidth = 560;
constexpr double kHeight = 400;
constexpr double kLeft = 64;
constexpr double kRight = 16;
constexpr double kTop = 36;
constexpr double kBottom = 52;
constexpr double kFieldWidth = kWidth - kLeft - kRight;
constexpr double kFieldHeight = kHeight - kTop - kBottom;
constexpr std::size_t kMostMarksInLines = 200;  // beyond, marks would hide the line

[[nodiscard]] std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto byte = i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U;
      group = group << 8U | byte;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool padding = i + k > bytes.size();
      text += padding ? '=' : kDigits[group >> (18U - 6U * k) & 63U];
    }
  }
  return text;
}

// The least of 1, 2, 5 times a power of ten that divides the axis into at most six.
[[nodiscard]] double tick_step(const PlotAxis& axis) {
  const double least = (axis.high - axis.low) / 6.0;
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= least) return factor * decade;
  }
  return 10.0 * decade;
}

class Field {
 public:
  Field(const PlotAxis& x, const PlotAxis& y) : x_(x), y_(y) {}
  [[nodiscard]] double px(double x) const {
    return kLeft + (x - x_.low) / (x_.high - x_.low) * kFieldWidth;
  }
  [[nodiscard]] double py(double y) const {
    return kTop + kFieldHeight - (y - y_.low) / (y_.high - y_.low) * kFieldHeight;
  }

 private:
  const PlotAxis& x_;
  const PlotAxis& y_;
};

// Calls draw(value, its text).
template <class Draw>
void for_each_tick(const PlotAxis& axis, Draw&& draw) {
  const double step = tick_step(axis);
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  const auto first = static_cast<std::int64_t>(std::ceil(axis.low / step - 1e-9));
  const auto last = static_cast<std::int64_t>(std::floor(axis.high / step + 1e-9));
  for (std::int64_t i = first; i <= last; ++i) {
    const double value = static_cast<double>(i) * step;
    draw(value, format("%.*f", decimals, value));
  }
}

[[nodiscard]] std::string grid(const PlotAxis& x, const PlotAxis& y, const Field& field) {
  std::string svg;
  for_each_tick(x, [&](double value, const std::string& number) {
    const double at = field.px(value);
    svg += format("<line x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f' class='grid'/>", at, at, kTop,
                  kTop + kFieldHeight);
    svg += format("<text x='%.1f' y='%.1f' class='tick' text-anchor='middle'>%s</text>", at,
                  kTop + kFieldHeight + 18, number.c_str());
  });
  for_each_tick(y, [&](double value, const std::string& number) {
    const double at = field.py(value);
    svg += format("<line x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f' class='grid'/>", kLeft,
                  kLeft + kFieldWidth, at, at);
    svg += format("<text x='%.1f' y='%.1f' class='tick' text-anchor='end'>%s</text>", kLeft - 8,
                  at + 4, number.c_str());
  });
  svg += format("<text x='%.1f' y='%.1f' class='axis' text-anchor='middle'>%s</text>",
                kLeft + kFieldWidth / 2, kHeight - 12, escaped(x.name).c_str());
  svg += format(
      "<text transform='translate(16 %.1f) rotate(-90)' class='axis' "
      "text-anchor='middle'>%s</text>",
      kTop + kFieldHeight / 2, escaped(y.name).c_str());
  return svg;
}

[[nodiscard]] std::string marks(const PlotSeries& series, const Field& field) {
  std::string svg;
  if (series.joined) {
    svg += "<polyline fill='none' stroke-width='1.5' stroke='" + series.colour + "' points='";
    for (const auto& point : series.points) {
      svg += format("%.1f,%.1f ", field.px(point.x), field.py(point.y));
    }
    svg += "'/>";
    if (series.points.size() > kMostMarksInLines) return svg;
  }
  for (const auto& point : series.points) {
    svg += format("<circle cx='%.1f' cy='%.1f' r='%s' fill='%s' fill-opacity='0.6'>",
                  field.px(point.x), field.py(point.y), series.joined ? "2" : "3.5",
                  series.colour.c_str());
    svg += "<title>" + escaped(point.tip) + "</title></circle>";
  }
  return svg;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string inline_png(std::string_view png, std::string_view description) {
  return "<img alt=\"" + escaped(description) + "\" src=\"data:image/png;base64," + base64(png) +
         "\">";
}

std::string svg_plot(const PlotAxis& x, const PlotAxis& y, const std::vector<PlotSeries>& series) {
  const Field field(x, y);
  std::string svg = format("<svg viewBox='0 0 %.0f %.0f' role='img'>", kWidth, kHeight);
  svg += grid(x, y, field);
  double legend = kLeft;
  for (const PlotSeries& one : series) {
    svg += format("<circle cx='%.1f' cy='16' r='4.5' fill='%s'/>", legend + 5, one.colour.c_str());
    svg += format("<text x='%.1f' y='20' class='axis'>%s</text>", legend + 15,
                  escaped(one.name).c_str());
    legend += 40 + 7.0 * static_cast<double>(one.name.size());
    svg += marks(one, field);
  }
  svg +=
      format("<rect x='%.1f' y='%.1f' width='%.1f' height='%.1f' fill='none' class='frame'/></svg>",
             kLeft, kTop, kFieldWidth, kFieldHeight);
  return svg;
}

}  // namespace convexcut::evaluation
