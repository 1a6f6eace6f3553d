#include <momenta/core/text/number_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/gradient_report.h>
#include <momenta/dae/output/json.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

/// Differences that agree to so many digits are not mentioned.
constexpr double enough_digits = 8;

/// θ dJ/dθ over J: relative change of J by that of θ.
double relative(const GradientResult& r, Eigen::Index j) {
  return r.variables[static_cast<std::size_t>(j)].value * r.gradient[j] / r.value;
}

std::string label(const RunVariable& v) {
  return v.unit.empty() ? v.name : v.name + " [" + v.unit + "]";
}

}  // namespace

std::string gradient_in_words(const GradientResult& r) {
  const RunSettings& s = r.settings;
  std::string text =
      (r.integral ? "The integral of " : "") + r.of + (r.integral ? " to t = " : " at t = ") +
      compact(r.end_time, 6) + " s is " + compact(r.value, 9) + "; form " + s.form +
      (s.gauge.empty() ? "" : ", gauge " + s.gauge) + (r.adjoint ? ", adjoint, " : ", ") +
      s.integrator +
      (s.step > 0 ? ", step " + compact(s.step, 6) + " s" : ", tolerance " + compact(s.rtol, 3)) +
      ", " + std::to_string(r.steps) + (r.steps == 1 ? " step." : " steps.");
  if (!r.without_effect.empty())
    text += " Without effect: " + reading::all_in_quotes(r.without_effect) + ".";
  std::vector<std::string> differenced;
  double digits = enough_digits;
  for (std::size_t j = 0; j < r.digits.size(); ++j)
    if (r.digits[j] < enough_digits) {
      differenced.push_back(r.variables[j].name);
      digits = std::min(digits, r.digits[j]);
    }
  if (!differenced.empty())
    text += "\nBy " + reading::all_in_quotes(differenced) +
            " the equations are differentiated by differences of neighbouring scenes, which agree "
            "to " +
            std::to_string(static_cast<int>(digits)) + " digits.";
  for (const std::string& remark : r.remarks) text += "\nRemark: " + remark + ".";
  return text;
}

std::string gradient_table(const GradientResult& r) {
  std::vector<std::vector<std::string>> rows{{"by", "value", "derivative", "relative"}};
  for (Eigen::Index j = 0; j < r.gradient.size(); ++j) {
    const RunVariable& v = r.variables[static_cast<std::size_t>(j)];
    const double part = relative(r, j);
    rows.push_back({label(v), compact(v.value, 6), compact(r.gradient[j], 9),
                    std::isfinite(part) ? compact(part, 3) : "-"});
  }
  return (r.scene.empty() ? "" : r.scene + ": ") + gradient_in_words(r) + "\n\n" + in_columns(rows);
}

std::string gradient_csv(const GradientResult& r) {
  std::vector<std::string> cells{"t [s]"};
  for (const RunVariable& v : r.variables)
    for (const std::string& column : r.columns)
      cells.push_back(csv_cell("d(" + column + ")/d(" + v.name + ")"));
  std::string text = csv_line(cells);
  for (std::size_t i = 0; i < r.times.size(); ++i) {
    cells = {round_trip(r.times[i])};
    for (const double x : r.tangents[i].reshaped()) cells.push_back(round_trip(x));
    text += csv_line(cells);
  }
  return text;
}

Json gradient_json(const GradientResult& r) {
  Json by = Json::object();
  for (Eigen::Index j = 0; j < r.gradient.size(); ++j) {
    const RunVariable& v = r.variables[static_cast<std::size_t>(j)];
    const char* kind = v.kind == RunVariable::Kind::parameter  ? "parameter"
                       : v.kind == RunVariable::Kind::position ? "start position"
                                                               : "start rate";
    by[v.name] = {{"kind", kind},
                  {"value", number_or_null(v.value)},
                  {"derivative", number_or_null(r.gradient[j])},
                  {"relative", number_or_null(relative(r, j))},
                  {"digits", j < static_cast<Eigen::Index>(r.digits.size())
                                 ? Json(std::floor(r.digits[static_cast<std::size_t>(j)]))
                                 : Json()}};
  }
  const RunSettings& s = r.settings;
  return {{"scene", r.scene},
          {"of", r.of},
          {"integral", r.integral},
          {"value", number_or_null(r.value)},
          {"by", by},
          {"without_effect", r.without_effect},
          {"remarks", r.remarks},
          {"mode", r.adjoint ? "adjoint" : "forward"},
          {"products", r.adjoint ? Json(r.products) : Json()},
          {"at_once", r.adjoint ? Json(r.at_once) : Json()},
          {"form", s.form},
          {"integrator", s.integrator},
          {"gauge", s.gauge.empty() ? Json() : Json(s.gauge)},
          {"rtol", s.rtol},
          {"step", s.step > 0 ? Json(s.step) : Json()},
          {"end", r.end_time},
          {"steps", r.steps}};
}

}  // namespace momenta
