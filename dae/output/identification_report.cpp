#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/identification_report.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/search_report.h>

#include <cmath>
#include <map>

namespace momenta {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// "0.0019 rad and 0.02 rad/s": root mean squares by unit.
std::string rms_in_words(const Identification& r, const MatrixXd& values) {
  std::map<std::string, std::pair<double, Index>> squares;  // by unit
  for (Index k = 0; k < values.cols(); ++k) {
    auto& [sum, count] = squares[r.measured.quantities[static_cast<std::size_t>(k)].unit];
    for (Index i = 0; i < values.rows(); ++i)
      if (const double off = values(i, k) - r.measured.values(i, k); !std::isnan(off))
        sum += off * off, ++count;
  }
  std::string text;
  for (const auto& [unit, of] : squares)
    if (of.second > 0)
      text += (text.empty() ? "" : " and ") +
              compact(std::sqrt(of.first / static_cast<double>(of.second)), 2) + " " + unit;
  return text;
}

}  // namespace

std::string identification_in_words(const Identification& r) {
  std::string text = "Of " + std::to_string(r.measured.count()) + " numbers measured at " +
                     std::to_string(r.measured.times.size()) + " times the rms error is " +
                     rms_in_words(r, r.after) + "; ";
  text += r.why_not_before.empty() ? "as the scene is, " + rms_in_words(r, r.before) + "."
                                   : "the scene as it is has no run: " + r.why_not_before + ".";
  text += starts_in_words(r) + at_ends_in_words(r.parameters, r.found);
  if (!r.undetermined.empty()) text += " " + r.undetermined;
  for (const std::string& remark : r.remarks) text += " Remark: " + remark + ".";
  return text;
}

std::string identification_table(const Identification& r) {
  return (r.scene.empty() ? "" : r.scene + ": ") + identification_in_words(r) + "\n\n" +
         parameters_table(r.parameters, r.own, r.found, r.deviations);
}

std::string identification_csv(const Identification& r) {
  std::vector<std::string> cells{"t [s]"};
  for (const Column& quantity : r.measured.quantities)
    for (const char* what : {".measured", "", ".before"})
      cells.push_back(csv_cell(quantity.name + what + " [" + quantity.unit + "]"));
  std::string text = csv_line(cells);
  for (Index i = 0; i < r.measured.values.rows(); ++i) {
    cells = {round_trip(r.measured.times[static_cast<std::size_t>(i)])};
    for (Index k = 0; k < r.measured.values.cols(); ++k) {
      const double y = r.measured.values(i, k);
      cells.push_back(std::isnan(y) ? "" : round_trip(y));
      cells.push_back(round_trip(r.after(i, k)));
      cells.push_back(r.before.size() > 0 ? round_trip(r.before(i, k)) : "");
    }
    text += csv_line(cells);
  }
  return text;
}

Json identification_json(const Identification& r) {
  Json quantities = Json::object();
  const MatrixXd after = r.errors(r.after),
                 before = r.before.size() > 0 ? r.errors(r.before) : MatrixXd();
  for (Index k = 0; k < after.rows(); ++k) {
    const Column& quantity = r.measured.quantities[static_cast<std::size_t>(k)];
    Json& of = quantities[quantity.name];
    of = {{"unit", quantity.unit}, {"rms", after(k, 0)}, {"max", after(k, 1)}};
    of["rms_before"] = before.size() > 0 ? Json(before(k, 0)) : Json();
    of["max_before"] = before.size() > 0 ? Json(before(k, 1)) : Json();
  }
  const RunSettings& s = r.settings;
  return {{"scene", r.scene},
          {"motion", "measured"},
          {"measured", r.measured.file},
          {"times", r.measured.times.size()},
          {"numbers", r.measured.count()},
          {"quantities", quantities},
          {"parameters", parameters_json(r.parameters, r.own, r.found, r.deviations)},
          {"cost",
           {{"before", number_or_null(r.cost_before)}, {"after", number_or_null(r.cost_after)}}},
          {"converged", r.starts[r.best].converged},
          {"at_ends", at_ends(r.parameters, r.found)},
          {"undetermined", r.undetermined.empty() ? Json() : Json(r.undetermined)},
          {"why_not_before", r.why_not_before.empty() ? Json() : Json(r.why_not_before)},
          {"remarks", r.remarks},
          {"seed", r.seed},
          {"starts", starts_json(r.parameters, r.starts)},
          {"best", r.best},
          {"stopped", r.stopped},
          {"runs", r.runs},
          {"form", s.form},
          {"integrator", s.integrator},
          {"gauge", s.gauge},
          {"rtol", s.rtol},
          {"step", s.step},
          {"end", s.end_time}};
}

Json identification_charts(const Identification& r) {
  SweptCharts charts({"t", "s"}, r.measured.times, 0);
  for (Index k = 0; k < r.measured.values.cols(); ++k) {
    const Column& quantity = r.measured.quantities[static_cast<std::size_t>(k)];
    std::vector<SweptCurve> curves{{"measured", r.measured.values.col(k), 1, {}},
                                   {"found", r.after.col(k), 0, {6, 4}}};
    if (r.before.size() > 0) curves.push_back({"before", r.before.col(k), 2, {2, 4}});
    charts.add(quantity.name, quantity.unit, curves);
  }
  return charts.json();
}

}  // namespace momenta
