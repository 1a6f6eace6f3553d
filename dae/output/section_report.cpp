#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/chart.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/page.h>
#include <momenta/dae/output/run_label.h>
#include <momenta/dae/output/section_report.h>
#include <momenta/dae/output/svg.h>
#include <momenta/dae/output/table.h>
#include <momenta/dae/study/column_named.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

constexpr double page_width = 640, page_height = 520, margin_left = 70, margin_right = 20,
                 margin_top = 20, margin_bottom = 60;

std::size_t points_of(const std::vector<SectionOrbit>& orbits) {
  std::size_t count = 0;
  for (const SectionOrbit& o : orbits) count += o.run.events.size();
  return count;
}

std::string start_in_words(const SectionPicture& p, const SectionOrbit& o) {
  return p.varied.empty() ? "the scene's start" : p.varied + " = " + compact(o.value, 6);
}

/// Calls act(x, y) at each point.
template <class Act>
void each_point(const SectionPicture& p, const SectionOrbit& o, Act&& act) {
  const auto& columns = o.run.trajectory.columns;
  const auto x = column_named(columns, p.x), y = column_named(columns, p.y);
  if (!x || !y) return;
  for (const FoundEvent& e : o.run.events)
    if (e.row.size() == columns.size()) act(e.row[*x], e.row[*y]);
}

std::string in_words(const SectionPicture& p, const std::vector<SectionOrbit>& orbits) {
  const std::size_t count = points_of(orbits);
  return std::to_string(count) + (count == 1 ? " point" : " points") + " of " +
         std::to_string(orbits.size()) + (orbits.size() == 1 ? " start" : " starts") + " where " +
         p.when + " passes zero" +
         (p.direction == "both" ? " either way"
          : p.direction == "up" ? " upwards"
                                : " downwards") +
         ".";
}

}  // namespace

std::string section_csv(const SectionPicture& p, const std::vector<SectionOrbit>& orbits) {
  std::string text;
  for (std::size_t k = 0; k < orbits.size(); ++k) {
    const RunResult& run = orbits[k].run;
    if (run.trajectory.columns.empty()) continue;
    if (text.empty()) {
      std::vector<std::string> head{"start", "varied", "t [s]", "direction"};
      for (std::size_t i = 1; i < run.trajectory.columns.size(); ++i)
        head.push_back(csv_cell(run.trajectory.columns[i]));
      if (!p.varied.empty()) head[1] = csv_cell("start of " + p.varied);
      text = csv_line(head);
    }
    for (const FoundEvent& e : run.events) {
      std::vector<std::string> cells{std::to_string(k), round_trip(orbits[k].value),
                                     round_trip(e.t), e.up ? "up" : "down"};
      for (std::size_t i = 1; i < e.row.size(); ++i) cells.push_back(round_trip(e.row[i]));
      text += csv_line(cells);
    }
  }
  return text;
}

nlohmann::ordered_json section_json(const SectionPicture& p,
                                    const std::vector<SectionOrbit>& orbits) {
  nlohmann::ordered_json json{{"scene", p.scene},   {"when", p.when}, {"direction", p.direction},
                              {"varied", p.varied}, {"x", p.x},       {"y", p.y}};
  json["points"] = points_of(orbits);
  json["starts"] = nlohmann::ordered_json::array();
  for (const SectionOrbit& o : orbits)
    json["starts"].push_back({{"value", number_or_null(o.value)},
                              {"energy", number_or_null(o.energy)},
                              {"points", o.run.events.size()},
                              {"status", o.left_out.empty() ? o.run.status : "left out"},
                              {"reason", o.left_out.empty() ? o.run.reason : o.left_out},
                              {"stopped_at", number_or_null(o.run.stopped_at)},
                              {"energy_error_max", number_or_null(o.run.energy_error_max)},
                              {"remarks", o.run.event_remarks}});
  return json;
}

std::string section_table(const SectionPicture& p, const std::vector<SectionOrbit>& orbits) {
  std::vector<std::vector<std::string>> rows{
      {"start", "points", "energy [J]", "energy error [J]", "ended"}};
  for (const SectionOrbit& o : orbits)
    rows.push_back({start_in_words(p, o), std::to_string(o.run.events.size()), compact(o.energy, 6),
                    scientific(o.run.energy_error_max, 1),
                    !o.left_out.empty() ? "left out: " + o.left_out
                    : finished(o.run)   ? o.run.status
                                        : o.run.status + ": " + o.run.reason});
  return (p.scene.empty() ? "" : p.scene + ": ") + in_words(p, orbits) + "\n\n" + in_columns(rows);
}

std::string section_svg(const SectionPicture& p, const std::vector<SectionOrbit>& orbits) {
  Range of_x, of_y;
  for (const SectionOrbit& o : orbits)
    each_point(p, o, [&](double x, double y) { of_x.take(x), of_y.take(y); });
  if (of_x.empty() || of_y.empty()) return "";
  const Axis x = axis_around(of_x, false, false, page_width - margin_left - margin_right),
             y = axis_around(of_y, false, false, page_height - margin_top - margin_bottom);
  const auto across = [&](double value) { return margin_left + x.at(value); };
  const auto down = [&](double value) { return page_height - margin_bottom - y.at(value); };
  std::string inside;
  for (const double tick : x.ticks(70))
    inside += svg::line(across(tick), margin_top, across(tick), page_height - margin_bottom,
                        "#dddddd", 1) +
              svg::text(across(tick), page_height - margin_bottom + 18, x.name(tick), "middle");
  for (const double tick : y.ticks(40))
    inside +=
        svg::line(margin_left, down(tick), page_width - margin_right, down(tick), "#dddddd", 1) +
        svg::text(margin_left - 8, down(tick) + 5, y.name(tick), "end");
  inside +=
      svg::text(0.5 * (margin_left + page_width - margin_right), page_height - 14, p.x, "middle");
  inside += svg::text(
      18, 0.5 * (margin_top + page_height - margin_bottom), p.y, "middle",
      svg::Attributes{
          {"transform", "rotate(-90 18 " +
                            svg::number(0.5 * (margin_top + page_height - margin_bottom)) + ")"}});
  for (std::size_t k = 0; k < orbits.size(); ++k) {
    const auto colour = static_cast<std::size_t>(sign_in_turn(k).colour);
    const std::string fill = palette[colour] == std::string("ink") ? "#000000" : palette[colour];
    std::string dots;
    each_point(p, orbits[k], [&](double px, double py) {
      dots += svg::element(
          "circle", {{"cx", svg::number(across(px))}, {"cy", svg::number(down(py))}, {"r", "1.8"}});
    });
    inside +=
        svg::element("g", svg::Attributes{{"fill", fill}},
                     svg::element("title", {}, escape_html(start_in_words(p, orbits[k]))) + dots);
  }
  return svg::document(page_width, page_height, "Section of " + p.scene,
                       in_words(p, orbits) + " Axes: " + x.words(p.x) + "; " + y.words(p.y) + ".",
                       inside);
}

std::string section_page(const SectionPicture& p, const std::vector<SectionOrbit>& orbits,
                         const Environment& environment, const std::string& command) {
  const std::string picture = section_svg(p, orbits);
  return plain_page(
      p.scene.empty() ? "Section" : p.scene, "section", escape_html(in_words(p, orbits)),
      section("Points", picture.empty() ? "<p>No point was found.</p>" : drawn(picture)) +
          section("Starts", preformatted(section_table(p, orbits))) +
          how_section(environment, command));
}

}  // namespace momenta
