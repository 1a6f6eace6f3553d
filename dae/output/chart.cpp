#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/chart.h>
#include <momenta/dae/output/svg.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace momenta {

namespace {

/// "10⁻³", or "2·10⁻³" between powers.
std::string power_text(double value) {
  const double exponent = std::floor(std::log10(value) + 1e-9);
  const auto mantissa = std::lround(value / std::pow(10.0, exponent));
  std::string text = mantissa == 1 ? "10" : std::to_string(mantissa) + "·10";
  static constexpr std::array<const char*, 10> raised{"⁰", "¹", "²", "³", "⁴",
                                                      "⁵", "⁶", "⁷", "⁸", "⁹"};
  for (const char c : svg::number(exponent))
    text += c == '-' ? "⁻" : raised[static_cast<std::size_t>(c - '0')];
  return text;
}

}  // namespace

void Range::take(double value) {
  low = std::min(low, value);
  high = std::max(high, value);
}

double Axis::at(double value) const {
  return log ? length * std::log(value / low) / std::log(high / low)
             : length * (value - low) / (high - low);
}

std::vector<double> Axis::ticks(double apart) const {
  std::vector<double> all;
  const double room = std::max(2.0, std::floor(length / apart));
  if (log) {
    const double first = std::floor(std::log10(low) + 1e-9),
                 last = std::ceil(std::log10(high) - 1e-9);
    const double stride = std::max(1.0, std::ceil((last - first) / room));
    const bool fine = stride == 1 && std::log10(high / low) < 2.5 && room > 3 * (last - first);
    for (double k = first; k <= last; k += stride)
      for (const double m : fine ? std::vector<double>{1, 2, 5} : std::vector<double>{1}) {
        const double value = m * std::pow(10.0, k);
        if (value >= low * 0.999 && value <= high * 1.001) all.push_back(value);
      }
    return all;
  }
  const double least = (high - low) / room, decade = std::pow(10.0, std::floor(std::log10(least)));
  double step = 10 * decade;
  for (const double m : {5.0, 2.0, 1.0})
    if (m * decade >= least) step = m * decade;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
    all.push_back(k * step);
  return all;
}

std::string Axis::name(double value) const {
  return log ? power_text(value) : std::abs(value) < 1e-12 * (high - low) ? "0" : compact(value, 6);
}

std::string Axis::words(const std::string& title) const {
  return title + " from " + round_trip(low) + " to " + round_trip(high) +
         (log ? ", logarithmic" : ", linear");
}

Axis axis_around(Range range, bool log, bool whole, double length) {
  if (range.empty()) range = log ? Range{1e-3, 1} : Range{0, 1};
  if (log && whole) {
    range.low = std::pow(10.0, std::floor(std::log10(range.low) + 1e-9));
    range.high = std::pow(10.0, std::ceil(std::log10(range.high) - 1e-9));
    if (!(range.high > range.low)) range.high = 10 * range.low;
  } else if (log && !(range.high > range.low)) {
    range.high = 10 * range.low;
  } else if (!log && whole) {
    const double room = range.high > range.low ? 0.06 * (range.high - range.low)
                                               : std::max(0.1 * std::abs(range.high), 1e-3);
    range = {range.low - room, range.high + room};
  } else if (!log && !(range.high > range.low)) {
    range.high = range.low + 1;
  }
  return {log, range.low, range.high, length};
}

std::string marker(const std::string& kind, double x, double y, double r, const std::string& fill) {
  static const std::vector<std::pair<double, double>> square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}},
      triangle{{0, -1.2}, {1.15, 0.85}, {-1.15, 0.85}},
      diamond{{0, -1.35}, {1.35, 0}, {0, 1.35}, {-1.35, 0}},
      plus{{-.4, -1.2}, {.4, -1.2}, {.4, -.4}, {1.2, -.4}, {1.2, .4},   {.4, .4},
           {.4, 1.2},   {-.4, 1.2}, {-.4, .4}, {-1.2, .4}, {-1.2, -.4}, {-.4, -.4}};
  std::vector<std::pair<double, double>> corners = kind == "square"     ? square
                                                   : kind == "triangle" ? triangle
                                                   : kind == "diamond"  ? diamond
                                                   : kind == "plus"     ? plus
                                                                        : square;
  if (kind == "circle")
    return svg::element("circle", {{"cx", svg::number(x)},
                                   {"cy", svg::number(y)},
                                   {"r", svg::number(r)},
                                   {"fill", fill},
                                   {"stroke", "#ffffff"}});
  if (kind == "star") {
    corners.clear();
    for (int k = 0; k < 10; ++k) {
      const double size = k % 2 == 1 ? 0.6 : 1.4, angle = std::numbers::pi * k / 5;
      corners.emplace_back(size * std::sin(angle), -size * std::cos(angle));
    }
  }
  std::string points;
  for (const auto& [dx, dy] : corners)
    points += (points.empty() ? "" : " ") + svg::number(x + r * dx) + "," + svg::number(y + r * dy);
  return svg::element("polygon", {{"points", points}, {"fill", fill}, {"stroke", "#ffffff"}});
}

std::string cross_at(double x, double y) {
  const std::string d = "M" + svg::number(x - 5) + " " + svg::number(y - 5) + "l10 10m0 -10l-10 10";
  return svg::element("path", {{"d", d}, {"stroke", "#a32a00"}, {"stroke-width", "3"}});
}

}  // namespace momenta
