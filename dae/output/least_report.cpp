#include <momenta/core/text/number_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/least_report.h>
#include <momenta/dae/output/search_report.h>

#include <cmath>
#include <numbers>

namespace momenta {
namespace {}  // namespace

std::string least_in_words(const LeastResult& r) {
  std::string text = r.least + " is " + compact(r.after, 6) + "; ";
  text += r.why_not_before.empty() ? "as the scene is, " + compact(r.before, 6) + "."
                                   : "the scene as it is has none: " + r.why_not_before + ".";
  text += starts_in_words(r);
  std::vector<std::string> at_limit;
  for (const UserConstraint& c : r.keep)
    if (!c.equal && c.multiplier > 0) at_limit.push_back(c.text);
  if (!at_limit.empty()) text += " Held by " + reading::all_in_quotes(at_limit) + ".";
  text += at_ends_in_words(r.parameters, r.found);
  for (const std::string& remark : r.remarks) text += " Remark: " + remark + ".";
  return text;
}

std::string least_table(const LeastResult& r) {
  return (r.scene.empty() ? "" : r.scene + ": ") + least_in_words(r) + "\n\n" +
         parameters_table(r.parameters, r.own, r.found) + kept_table(r.keep);
}

std::string least_csv(const LeastResult& r) {
  std::vector<std::string> cells{csv_cell(r.swept ? r.swept->label() : "")};
  for (const auto& curve : r.curves)
    for (const char* when : {"", " before"}) cells.push_back(csv_cell(curve.formula + when));
  std::string text = csv_line(cells);
  for (std::size_t i = 0; i < r.places.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    cells = {round_trip(r.places[i])};
    for (const auto& curve : r.curves) {
      cells.push_back(round_trip(curve.after[at]));
      cells.push_back(curve.before.size() > 0 ? round_trip(curve.before[at]) : "");
    }
    text += csv_line(cells);
  }
  return text;
}

Json least_json(const LeastResult& r) {
  Json parameters = parameters_json(r.parameters, r.own, r.found);
  for (std::size_t j = 0; j < r.parameters.size(); ++j)
    parameters[r.parameters[j].name]["derivative"] =
        number_or_null(r.gradient[static_cast<Eigen::Index>(j)]);
  Json starts = Json::array();
  for (const LeastStart& s : r.starts)
    starts.push_back({{"from", values_json(r.parameters, s.from)},
                      {"to", values_json(r.parameters, s.to)},
                      {"value", number_or_null(s.value)},
                      {"violation", number_or_null(s.violation)},
                      {"slope", number_or_null(s.slope)},
                      {"iterations", s.iterations},
                      {"converged", s.converged},
                      {"why", s.why.empty() ? Json() : Json(s.why)}});
  return {{"scene", r.scene},
          {"least", r.least},
          {"motion", r.run ? "run" : "swept"},
          {"swept", r.swept ? Json(r.swept->label()) : Json()},
          {"before", number_or_null(r.before)},
          {"after", number_or_null(r.after)},
          {"parameters", parameters},
          {"keep", kept_json(r.keep)},
          {"converged", r.starts[r.best].converged},
          {"why_not_before", r.why_not_before.empty() ? Json() : Json(r.why_not_before)},
          {"seed", r.seed},
          {"starts", starts},
          {"best", r.best},
          {"stopped", r.stopped},
          {"remarks", r.remarks},
          {"evaluations", r.evaluations},
          {"derivatives", r.derivatives}};
}

Json least_charts(const LeastResult& r, double first) {
  if (!r.swept) return Json::array();
  // The film goes half a turn to each side of the start: angles are reported accordingly.
  constexpr double turn = 2 * std::numbers::pi;
  const bool whole = r.swept->unit == "rad" && !r.places.empty() &&
                     std::abs(r.places.back() - r.places.front() - turn) < 1e-9;
  std::vector<double> places = r.places;
  if (whole) {
    places.pop_back();
    for (double& s : places)
      if (s > first + turn) s -= turn;
  }
  SweptCharts charts(*r.swept, places, first);
  for (const auto& curve : r.curves) {
    std::vector<SweptCurve> curves{{"found", curve.after, 0, {}}};
    if (curve.before.size() > 0) curves.push_back({"before", curve.before, 2, {2, 4}});
    charts.add(curve.formula, "", curves);
  }
  return charts.json();
}

}  // namespace momenta
