#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/fit_report.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/search_report.h>

#include <cmath>

namespace momenta {
namespace {

/// "12 mm and 0.02 rad".
std::string largest(const WantedErrors& e) {
  std::string text;
  if (!std::isnan(e.length_most)) text = length_text(e.length_most);
  if (!std::isnan(e.angle_most))
    text += (text.empty() ? "" : " and ") + compact(e.angle_most, 2) + " rad";
  return text;
}

Json errors_json(const WantedErrors& e) {
  return {{"cost", number_or_null(e.cost)},
          {"length_rms", number_or_null(e.length_rms)},
          {"length_max", number_or_null(e.length_most)},
          {"angle_rms", number_or_null(e.angle_rms)},
          {"angle_max", number_or_null(e.angle_most)}};
}

}  // namespace

std::string fit_in_words(const FitResult& r) {
  std::string text = "The largest error of " + std::to_string(r.wanted.poses()) +
                     (r.wanted.poses() == 1 ? " pose is " : " poses is ") + largest(r.after) + "; ";
  text += r.why_not_before.empty()
              ? "as the scene is, " + largest(r.before) + "."
              : "the scene as it is does not come to all: " + r.why_not_before + ".";
  text += starts_in_words(r) + at_ends_in_words(r.parameters, r.found);
  return text + (r.undetermined.empty() ? "" : " " + r.undetermined);
}

std::string fit_table(const FitResult& r) {
  return (r.scene.empty() ? "" : r.scene + ": ") + fit_in_words(r) + "\n\n" +
         parameters_table(r.parameters, r.own, r.found) + kept_table(r.keep);
}

std::string fit_csv(const FitResult& r) {
  std::vector<std::string> cells{csv_cell(r.swept.label())};
  for (const auto& quantity : r.wanted.quantities)
    for (const char* what : {".wanted", "", ".before"})
      cells.push_back(csv_cell(quantity.name + what + " [" + quantity.unit + "]"));
  std::string text = csv_line(cells);
  for (Eigen::Index i = 0; i < r.wanted.poses(); ++i) {
    cells = {round_trip(r.places[static_cast<std::size_t>(i)])};
    for (Eigen::Index k = 0; k < r.wanted.values.cols(); ++k) {
      cells.push_back(round_trip(r.wanted.values(i, k)));
      cells.push_back(round_trip(r.reached(i, k)));
      cells.push_back(r.reached_before.size() > 0 ? round_trip(r.reached_before(i, k)) : "");
    }
    text += csv_line(cells);
  }
  return text;
}

Json fit_json(const FitResult& r) {
  return {{"scene", r.scene},
          {"swept", r.swept.label()},
          {"wanted", r.wanted.file},
          {"poses", r.wanted.poses()},
          {"places_given", !r.wanted.swept.empty()},
          {"parameters", parameters_json(r.parameters, r.own, r.found)},
          {"errors", {{"before", errors_json(r.before)}, {"after", errors_json(r.after)}}},
          {"keep", kept_json(r.keep)},
          {"converged", r.starts[r.best].converged},
          {"at_ends", at_ends(r.parameters, r.found)},
          {"undetermined", r.undetermined.empty() ? Json() : Json(r.undetermined)},
          {"why_not_before", r.why_not_before.empty() ? Json() : Json(r.why_not_before)},
          {"seed", r.seed},
          {"starts", starts_json(r.parameters, r.starts)},
          {"best", r.best},
          {"stopped", r.stopped},
          {"evaluations", r.evaluations},
          {"derivatives", r.derivatives}};
}

Json fit_charts(const FitResult& r, double first) {
  SweptCharts charts(r.swept, r.places, first);
  for (Eigen::Index k = 0; k < r.wanted.values.cols(); ++k) {
    const auto& quantity = r.wanted.quantities[static_cast<std::size_t>(k)];
    std::vector<SweptCurve> curves{{"wanted", r.wanted.values.col(k), 1, {}},
                                   {"found", r.reached.col(k), 0, {6, 4}}};
    if (r.reached_before.size() > 0)
      curves.push_back({"before", r.reached_before.col(k), 2, {2, 4}});
    charts.add(quantity.name, quantity.unit, curves);
  }
  return charts.json();
}

}  // namespace momenta
