#include <momenta/dae/output/chart.h>
#include <momenta/dae/output/figure.h>
#include <momenta/dae/output/sampled_curves.h>
#include <momenta/dae/output/svg.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

constexpr double plot_left = 76, plot_top = 34, plot_width = 480, least_plot_height = 300;
constexpr double label_gap = 17, points_on_paper = 600;
constexpr std::size_t most_labels = 40;
constexpr const char *ink = "#17191d", *muted = "#525a66", *grid = "#e0e3e8";

std::string colour_of(const Sign& sign) {
  const std::string colour = palette.at(static_cast<std::size_t>(sign.colour));
  return colour == "ink" ? ink : colour;
}
std::string dash_of(const std::vector<double>& dash) {
  std::string text;
  for (const double d : dash) text += (text.empty() ? "" : " ") + svg::number(d);
  return text;
}

struct Drawn {
  const Curve* curve;
  std::vector<double> x, y, top;
  bool wavy = false;
};

Drawn drawn_of(const Chart& chart, const Curve& curve) {
  Drawn d{&curve, {}, {}, {}};
  std::vector<std::size_t> kept(curve.x.size());
  if (curve.dots)
    for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = i;
  else
    kept = thinned(curve.x, curve.y, static_cast<std::size_t>(points_on_paper), chart.log_x);
  std::vector<double> top = curve.y;
  double largest = 0;
  for (double& v : top)
    if (chart.running_maximum && std::isfinite(v)) v = largest = std::max(largest, v);
  for (const std::size_t i : kept) {
    d.x.push_back(curve.x[i]);
    d.y.push_back(curve.y[i]);
    d.top.push_back(top[i]);
    d.wavy = d.wavy || curve.y[i] < 0.8 * top[i];
  }
  return d;
}

class ChartDrawing {
 public:
  explicit ChartDrawing(const Chart& chart) : chart_(chart) {
    Range x, y, faint;
    for (const Curve& curve : chart.curves) {
      if (drawn_.size() == most_labels) break;
      Drawn d = drawn_of(chart, curve);
      if (d.x.empty()) continue;
      for (std::size_t i = 0; i < d.x.size(); ++i) {
        x.take(d.x[i]);
        y.take(d.top[i]);
        faint.take(d.y[i]);
      }
      drawn_.push_back(std::move(d));
    }
    // Faint lines reach two decades below the strong ones.
    if (chart.running_maximum && !y.empty()) y.take(std::max(faint.low, y.low / 100));
    height_ = std::max(least_plot_height, label_gap * (1 + static_cast<double>(drawn_.size())));
    const bool dots = std::any_of(chart.curves.begin(), chart.curves.end(),
                                  [](const Curve& c) { return c.dots; });
    if (dots && !x.empty()) x = {x.low / 1.3, x.high * 1.3};
    x_ = axis_around(x, chart.log_x, false, plot_width);
    y_ = axis_around(y, chart.log_y, true, height_);
  }

  std::string markup() const {
    const bool alone = chart_.curves.size() == 1;
    double widest = 0;
    for (const Drawn& d : drawn_) widest = std::max(widest, svg::width_of(d.curve->name));
    const double right = alone ? 24 : 42 + widest;
    std::string inside =
        frame() + reference_lines() + curves() + (alone ? ends() : ends() + names());
    std::string names_of;
    for (const Drawn& d : drawn_) names_of += (names_of.empty() ? "" : ", ") + d.curve->name;
    return svg::document(plot_left + plot_width + right, plot_top + height_ + 52, chart_.title,
                         "x: " + x_.words(chart_.x_title) + "; y: " + y_.words(chart_.y_title) +
                             "; curves: " + names_of,
                         inside);
  }

 private:
  double px(double x) const { return plot_left + x_.at(x); }
  double py(double y) const { return plot_top + height_ - y_.at(y); }

  std::string frame() const {
    std::string lines, words;
    for (const double tick : x_.ticks(70)) {
      lines += svg::line(px(tick), plot_top, px(tick), plot_top + height_, grid, 1);
      words += svg::text(px(tick), plot_top + height_ + 19, x_.name(tick), "middle");
    }
    for (const double tick : y_.ticks(36)) {
      lines += svg::line(plot_left, py(tick), plot_left + plot_width, py(tick), grid, 1);
      words += svg::text(plot_left - 8, py(tick) + 5, y_.name(tick), "end");
    }
    words +=
        svg::text(plot_left + plot_width / 2, plot_top + height_ + 42, chart_.x_title, "middle");
    words += svg::text(plot_left - 62, 20, chart_.y_title, "start");
    return lines +
           svg::element("rect", {{"class", "plot"},
                                 {"x", svg::number(plot_left)},
                                 {"y", svg::number(plot_top)},
                                 {"width", svg::number(plot_width)},
                                 {"height", svg::number(height_)},
                                 {"fill", "none"},
                                 {"stroke", muted}}) +
           words;
  }

  /// Reference lines from a place three times above the largest curve's end; others start there.
  std::string reference_lines() const {
    if (chart_.slopes.empty() || drawn_.empty()) return "";
    const Drawn& largest = *std::max_element(
        drawn_.begin(), drawn_.end(),
        [](const Drawn& a, const Drawn& b) { return a.top.back() < b.top.back(); });
    const double steepest = *std::max_element(chart_.slopes.begin(), chart_.slopes.end());
    const double start = largest.x.front(), end = largest.x.back();
    const double y = std::max(3 * largest.top.back() * std::pow(start / end, steepest), y_.low);
    std::string markup;
    for (const double slope : chart_.slopes) {
      const double stop = std::min(end, start * std::pow(y_.high / y, 1 / slope));
      markup += svg::element("line", {{"x1", svg::number(px(start))},
                                      {"y1", svg::number(py(y))},
                                      {"x2", svg::number(px(stop))},
                                      {"y2", svg::number(py(y * std::pow(stop / start, slope)))},
                                      {"stroke", muted},
                                      {"stroke-dasharray", "5 5"}});
      const double middle = std::pow(start, 0.4) * std::pow(stop, 0.6);
      markup += svg::text(px(middle), py(y * std::pow(middle / start, slope)) - 8,
                          slope == 1 ? "∝ t" : "∝ t²", "middle", {{"fill", muted}});
    }
    return markup;
  }

  std::string path(const std::vector<double>& x, const std::vector<double>& y) const {
    std::string d;
    bool pen = false;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!std::isfinite(y[i])) {
        pen = false;
        continue;
      }
      const double low = plot_top + height_;
      d += (pen ? "L" : "M") + svg::number(px(x[i])) + " " + svg::number(std::min(py(y[i]), low));
      pen = true;
    }
    return d;
  }
  std::string stroke(const std::string& d, const std::string& colour, double width,
                     const std::string& dash, const char* kind, double opacity = 1) const {
    svg::Attributes all{{"class", kind},
                        {"d", d},
                        {"fill", "none"},
                        {"stroke", colour},
                        {"stroke-width", svg::number(width)},
                        {"stroke-linejoin", "round"}};
    if (!dash.empty()) all.emplace_back("stroke-dasharray", dash);
    if (opacity < 1) all.emplace_back("stroke-opacity", svg::number(opacity));
    return svg::element("path", all);
  }

  std::string curves() const {
    std::string markup;
    for (const Drawn& d : drawn_)
      if (d.wavy)
        markup += stroke(path(d.x, d.y), colour_of(d.curve->sign), 0.75, "", "faint",
                         drawn_.size() > 6 ? 0.15 : 0.4);
    for (const Drawn& d : drawn_) {
      const std::string line = path(d.x, d.top);
      if (d.curve->sign.colour == yellow && d.x.size() > 1)
        markup += stroke(line, "#6b6200", 4, "", "outline");
      if (d.x.size() > 1)
        markup += stroke(line, colour_of(d.curve->sign), 2, dash_of(d.curve->sign.dash), "curve");
    }
    return markup;
  }

  bool markers() const {
    return std::any_of(drawn_.begin(), drawn_.end(),
                       [](const Drawn& d) { return d.curve->sign.marker != "circle"; });
  }

  std::string ends() const {
    std::string markup;
    for (const Drawn& d : drawn_) {
      const std::string fill = colour_of(d.curve->sign);
      for (std::size_t i = 0; i < d.x.size() && d.curve->dots; ++i)
        markup += marker(d.curve->sign.marker, px(d.x[i]), py(d.top[i]), 5, fill);
      if (d.curve->failed)
        markup += cross_at(px(d.x.back()), py(d.top.back()));
      else if (!d.curve->dots && markers())
        markup += marker(d.curve->sign.marker, px(d.x.back()), py(d.top.back()), 4.5, fill);
    }
    return markup;
  }

  /// Right of the plot, as near to the curves' ends as there is room.
  std::string names() const {
    std::vector<const Drawn*> order;
    for (const Drawn& d : drawn_) order.push_back(&d);
    const auto y_of = [&](const Drawn* d) {
      return std::isfinite(d->top.back()) ? py(d->top.back()) : plot_top + height_;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](const Drawn* a, const Drawn* b) { return y_of(a) < y_of(b); });
    std::vector<double> heights;
    double last = plot_top - label_gap / 2;
    for (const Drawn* d : order) heights.push_back(last = std::max(y_of(d), last + label_gap));
    double next = plot_top + height_ + label_gap / 2;
    for (std::size_t i = heights.size(); i-- > 0;)
      next = heights[i] = std::min(heights[i], next - label_gap);
    const double right = plot_left + plot_width;
    std::string markup;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Drawn& d = *order[i];
      markup += svg::line(right + 2, y_of(&d), right + 14, heights[i], muted, 0.7);
      svg::Attributes swatch{
          {"d", "M" + svg::number(right + 16) + " " + svg::number(heights[i]) + "h18"},
          {"stroke", colour_of(d.curve->sign)},
          {"stroke-width", "3"}};
      if (!d.curve->sign.dash.empty())
        swatch.emplace_back("stroke-dasharray", dash_of(d.curve->sign.dash));
      markup += svg::element("path", swatch);
      if (d.curve->dots || markers())
        markup +=
            marker(d.curve->sign.marker, right + 25, heights[i], 4.5, colour_of(d.curve->sign));
      markup += svg::text(right + 38, heights[i] + 5, d.curve->name);
    }
    return markup;
  }

  const Chart& chart_;
  std::vector<Drawn> drawn_;
  Axis x_{}, y_{};
  double height_ = least_plot_height;
};

}  // namespace

std::string chart_svg(const Chart& chart) {
  return ChartDrawing(chart).markup();
}

}  // namespace momenta
