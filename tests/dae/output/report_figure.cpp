// Figures for papers: well-formed, without script, and every point of a curve one of the data.
#include <dae/output/page/synthetic_study.h>
#include <gtest/gtest.h>
#include <momenta/dae/output/figure.h>
#include <momenta/dae/output/run_label.h>
#include <momenta/dae/output/svg.h>

#include <regex>
#include <set>

namespace momenta::dae_report_figure {
namespace {

/// What is wrong with it as XML, or nothing: tags closed in order, one root, quotes closed, no bare
/// & or <.
std::string xml_fault(const std::string& xml) {
  std::vector<std::string> open;
  bool rooted = false;
  for (std::size_t i = 0; i < xml.size();) {
    if (xml[i] == '&') {
      if (!std::regex_search(xml.begin() + static_cast<long>(i), xml.end(),
                             std::regex("^&(amp|lt|gt|quot|#39);"),
                             std::regex_constants::match_continuous))
        return "a bare & at " + std::to_string(i);
      ++i;
    } else if (xml[i] == '<') {
      std::size_t end = i;
      bool quoted = false;
      while (end < xml.size() && (xml[end] != '>' || quoted)) quoted ^= xml[end++] == '"';
      if (end == xml.size()) return "a tag without end";
      const std::string tag = xml.substr(i + 1, end - i - 1);
      const std::string name =
          tag.substr(tag[0] == '/' ? 1 : 0, tag.find_first_of(" />", 1) - (tag[0] == '/' ? 1 : 0));
      if (tag[0] == '/') {
        if (open.empty() || open.back() != tag.substr(1))
          return "</" + tag.substr(1) + "> closes nothing";
        open.pop_back();
      } else {
        if (open.empty() && rooted) return "a second root";
        rooted = true;
        if (tag.back() != '/') open.push_back(name);
        std::set<std::string> names;
        const std::regex attribute(" ([a-z-]+)=\"[^\"<]*\"");
        for (auto a = std::sregex_iterator(tag.begin(), tag.end(), attribute);
             a != std::sregex_iterator(); ++a)
          if (!names.insert((*a)[1]).second) return "attribute twice in <" + tag + ">";
      }
      i = end + 1;
    } else {
      ++i;
    }
  }
  return open.empty() && rooted ? "" : "not closed";
}

struct Reading {
  bool log;
  double low, high, from, length;
  double pixel(double v) const {
    return log ? from + length * std::log(v / low) / std::log(high / low)
               : from + length * (v - low) / (high - low);
  }
};

/// The axes as <desc> and the frame of the plot tell them.
std::pair<Reading, Reading> axes_of(const std::string& svg) {
  std::smatch desc, frame;
  const std::regex words(
      "<desc>x: .* from (\\S+) to (\\S+), (\\w+); y: .* from (\\S+) to (\\S+), (\\w+);");
  const std::regex rect(
      "class=\"plot\" x=\"(\\S+)\" y=\"(\\S+)\" width=\"(\\S+)\" height=\"(\\S+)\"");
  EXPECT_TRUE(std::regex_search(svg, desc, words)) << svg.substr(0, 600);
  EXPECT_TRUE(std::regex_search(svg, frame, rect));
  const auto at = [](const std::smatch& m, std::size_t i) { return std::stod(m[i].str()); };
  return {{desc[3] == "logarithmic", at(desc, 1), at(desc, 2), at(frame, 1), at(frame, 3)},
          {desc[6] == "logarithmic", at(desc, 4), at(desc, 5), at(frame, 2) + at(frame, 4),
           -at(frame, 4)}};
}

std::vector<std::pair<double, double>> points_of(const std::string& d) {
  std::vector<std::pair<double, double>> points;
  const std::regex step("[ML](-?[0-9.]+) (-?[0-9.]+)");
  for (auto s = std::sregex_iterator(d.begin(), d.end(), step); s != std::sregex_iterator(); ++s)
    points.emplace_back(std::stod((*s)[1]), std::stod((*s)[2]));
  return points;
}

/// Every point drawn is one of the data, and the first, the last and the largest of them are drawn.
void expect_data(const Chart& chart) {
  const std::string svg = chart_svg(chart);
  EXPECT_EQ(xml_fault(svg), "") << chart.key;
  EXPECT_EQ(svg.find("script"), std::string::npos);
  EXPECT_EQ(svg.find("onclick"), std::string::npos);
  const auto [x, y] = axes_of(svg);
  const std::regex path("<path class=\"curve\" d=\"([^\"]*)\"");
  std::size_t curve = 0;
  for (auto p = std::sregex_iterator(svg.begin(), svg.end(), path); p != std::sregex_iterator();
       ++p, ++curve) {
    ASSERT_LT(curve, chart.curves.size());
    const Curve& data = chart.curves[curve];
    std::vector<std::pair<double, double>> all;
    double top = 0;
    for (std::size_t i = 0; i < data.x.size(); ++i) {
      if (chart.log_x && !(data.x[i] > 0)) continue;
      top = chart.running_maximum ? std::max(top, data.y[i]) : data.y[i];
      all.emplace_back(x.pixel(data.x[i]), std::min(y.pixel(top), y.from));
    }
    const auto drawn = points_of((*p)[1]);
    ASSERT_GT(drawn.size(), 1u);
    const auto near = [](const auto& a, const auto& b) {
      return std::abs(a.first - b.first) < 0.011 && std::abs(a.second - b.second) < 0.011;
    };
    std::size_t next = 0;  // both go from left to right
    for (const auto& point : drawn) {
      while (next < all.size() && !near(all[next], point)) ++next;
      ASSERT_LT(next, all.size()) << chart.key << ": " << point.first << ", " << point.second;
    }
    EXPECT_TRUE(near(drawn.front(), all.front()));
    EXPECT_TRUE(near(drawn.back(), all.back()));
    const auto highest = [](const auto& a, const auto& b) { return a.second < b.second; };
    EXPECT_NEAR(std::min_element(drawn.begin(), drawn.end(), highest)->second,
                std::min_element(all.begin(), all.end(), highest)->second, 0.011);
  }
  EXPECT_EQ(curve, chart.curves.size()) << chart.key;
}

TEST(Figure, CurvesOfAStudyAreItsSeries) {
  const auto charts = charts_of_study(synthetic::all_forms());
  ASSERT_EQ(charts.size(), 5u);
  for (std::size_t i = 0; i < 4; ++i) expect_data(charts[i]);
}

TEST(Figure, CurvesOfARunAreItsTrajectory) {
  RunResult run = synthetic::run_of({}, 10, 3000);
  run.trajectory.columns = {"t [s]", "O.q [rad]", "A.q [rad]", "O.u [rad/s]", "energy [J]"};
  for (int i = 0; i <= 3000; ++i) {
    const double t = i / 300.0;
    run.trajectory.rows.push_back({t, std::sin(9 * t) - 2, 0.1 * t, std::cos(40 * t), 1});
  }
  const auto charts = charts_of_run(run);
  ASSERT_EQ(charts.size(), 6u);
  EXPECT_EQ(charts[4].key, "angles");
  EXPECT_EQ(charts[4].curves.size(), 2u);
  for (const Chart& chart : charts) expect_data(chart);
}

TEST(Figure, NamesAreEscapedAndLaddersHaveTheirMarkers) {
  StudyResult study = synthetic::ladder();
  study.runs.front().settings.gauge = "<&\">";
  for (const Figure& figure : figures_of_study(study))
    EXPECT_EQ(xml_fault(figure.svg), "") << figure.name;
  const auto charts = charts_of_study(synthetic::ladder());
  const Chart& cost = charts[charts.size() - 4];
  EXPECT_EQ(cost.key, "error_cost");
  ASSERT_EQ(cost.curves.size(), 6u);
  EXPECT_EQ(cost.curves[0].x.size(), 5u);
  EXPECT_NE(cost.curves[0].sign.marker, cost.curves[1].sign.marker);
  EXPECT_EQ(cost.curves[0].sign.colour, cost.curves[1].sign.colour);
}

TEST(Figure, AFormHasItsOwnColour) {
  const auto study = synthetic::all_forms();
  const auto signs = signs_of(study);
  std::set<std::pair<int, std::vector<double>>> seen;
  for (const Sign& sign : signs) EXPECT_TRUE(seen.insert({sign.colour, sign.dash}).second);
  EXPECT_EQ(signs[0].colour, 0);  // momentum
  EXPECT_EQ(signs[5].colour, 1);  // acceleration
}

TEST(Figure, TheMechanismIsDrawnWithinItsFrame) {
  const Picture picture = synthetic::four_bar();
  const std::string svg = mechanism_svg(picture, synthetic::motion(0, 1, 2).frames[0]);
  EXPECT_EQ(xml_fault(svg), "");
  std::smatch size;
  ASSERT_TRUE(std::regex_search(svg, size, std::regex("width=\"(\\S+)\" height=\"(\\S+)\"")));
  const std::regex x("c?x[12]?=\"(-?[0-9.]+)\"");
  int seen = 0;
  for (auto m = std::sregex_iterator(svg.begin(), svg.end(), x); m != std::sregex_iterator(); ++m) {
    ++seen;
    EXPECT_GE(std::stod((*m)[1]), 0);
    EXPECT_LE(std::stod((*m)[1]), std::stod(size[1]));
  }
  EXPECT_GE(seen, 6);  // both ends of three links
}

}  // namespace
}  // namespace momenta::dae_report_figure
