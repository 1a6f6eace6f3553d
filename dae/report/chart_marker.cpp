#include <momenta/dae/report/chart_marker.h>
#include <momenta/dae/report/svg.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace momenta {

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
