#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/equation_report.h>
#include <momenta/dae/output/index_report.h>
#include <momenta/dae/output/json.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

using structure::at;

/// "(1) - 2·(3)'": a combination without its small parts.
std::string combination_of(const Eigen::VectorXd& parts, const structure::Offsets& offsets) {
  std::string text;
  for (Eigen::Index i = 0; i < parts.size(); ++i) {
    if (std::abs(parts[i]) < 1e-9) continue;
    const int c = offsets.equation[static_cast<std::size_t>(i)];
    std::string factor = compact(std::abs(parts[i]), 4);
    factor = factor == "1" ? "" : factor + "·";
    text += (text.empty()   ? (parts[i] < 0 ? "-" : "")
             : parts[i] < 0 ? " - "
                            : " + ") +
            factor + "(" + std::to_string(i + 1) + ")" + std::string(at(c), '\'');
  }
  return text;
}

/// Why the two indices differ.
std::string verdict(const EquationStart& start) {
  const int n = static_cast<int>(start.offsets.equation.size());
  const int index = start.point.found.index, structural = start.offsets.index;
  if (start.jacobian.regular(n)) {
    if (index == structural)
      return "Structure gives the index: the system Jacobian is regular, so the differentiated "
             "equations give the highest derivatives.\n";
    return "Structure differentiates more than y' needs: the system Jacobian is regular, so the "
           "differentiation index is at most the structural one, and here it is less by " +
           std::to_string(structural - index) + ".\n";
  }
  std::string text =
      "Structure says nothing of the index here: the system Jacobian is singular, rank " +
      std::to_string(start.jacobian.rank.rank) + " of " + std::to_string(n) +
      (index == structural ? ", and that the two agree is chance" : "") +
      ". No highest derivative is left in\n";
  for (const Eigen::VectorXd& parts : start.jacobian.cancelling)
    text += "  " + combination_of(parts, start.offsets) + "\n";
  return text + "with ' for each differentiation: a constraint that the signature does not show.\n";
}

std::string name_of(const EquationFile& file) {
  return file.name.empty() ? "equations" : file.name;
}

}  // namespace

std::string moved_in_words(const EquationFile& file, const EquationStart& start) {
  std::string text;
  for (int j = 0; j < file.size(); ++j) {
    const double guess = file.values[at(j)], value = start.point.y[j];
    if (std::abs(value - guess) <= 1e-12 * (file.scales[at(j)] + std::abs(guess))) continue;
    text += (text.empty() ? "" : ", ") + file.variables[at(j)] + " " + compact(guess, 6) + " → " +
            compact(value, 6);
  }
  return text;
}

std::string equation_index_table(const EquationFile& file, const EquationStart& start) {
  const int n = file.size();
  const structure::Offsets& o = start.offsets;
  std::string text = name_of(file) + ": " + std::to_string(n) +
                     (n == 1 ? " equation" : " equations") + "; at t = " + compact(file.start, 4) +
                     "\n\n";
  const IndexFound& found = start.point.found;
  const bool known = start.point.why.empty();
  std::vector<std::vector<std::string>> rows{
      {"differentiation index", known ? std::to_string(found.index) : "-",
       known ? "derivative array: y' free " + over_levels(found, &ArrayLevel::undetermined) +
                   ", constraints " + over_levels(found, &ArrayLevel::constraints) + ", gap " +
                   scientific(smallest_gap(found), 1)
             : start.point.why},
      {"structural index", std::to_string(o.index),
       std::string("Σ-method; Pantelides' algorithm differentiates ") +
           (start.pantelides == o.equation ? "the same equations" : "other equations")},
      {"degrees of freedom", std::to_string(o.freedom), "by structure"}};
  if (known) {
    rows.push_back({"", std::to_string(n - found.levels.back().constraints),
                    "by the array: unknowns less constraints"});
    rows.push_back({"system Jacobian", start.jacobian.regular(n) ? "regular" : "singular",
                    "rank " + std::to_string(start.jacobian.rank.rank) + " of " +
                        std::to_string(n) + ", determinant " +
                        compact(start.jacobian.determinant, 4)});
  }
  text += in_columns(rows) + "\n";
  rows = {{"equation", "c", ""}};
  for (int i = 0; i < n; ++i)
    rows.push_back({"(" + std::to_string(i + 1) + ")", std::to_string(o.equation[at(i)]),
                    file.equations[at(i)].text});
  text += in_columns(rows) + "\n";
  rows = {{"variable", "d", "index", "given by", "start", "rate"}};
  for (int j = 0; j < n; ++j) {
    const auto by = std::find(o.transversal.begin(), o.transversal.end(), j);
    rows.push_back({file.variables[at(j)], std::to_string(o.variable[at(j)]),
                    known ? std::to_string(start.index_of[at(j)]) : "-",
                    "(" + std::to_string(by - o.transversal.begin() + 1) + ")",
                    known ? compact(start.point.y[j], 6) : "-",
                    known ? compact(start.point.ydot[j], 6) : "-"});
  }
  text += in_columns(rows) +
          "\nc: differentiations of an equation, d: derivatives of a variable that they give.\n";
  if (!known) return text;
  text += verdict(start);
  if (const std::string moved = moved_in_words(file, start); !moved.empty())
    text += "The start was moved onto the constraints: " + moved + "\n";
  return text;
}

Json equation_index_json(const EquationFile& file, const EquationStart& start) {
  const int n = file.size();
  const bool known = start.point.why.empty();
  const structure::Offsets& o = start.offsets;
  Json j;
  j["name"] = file.name;
  j["t"] = file.start;
  j["unknowns"] = n;
  j["index"] = known ? Json(start.point.found.index) : Json(nullptr);
  j["why"] = start.point.why;
  j["levels"] = levels_json(start.point.found);
  Json& structural = j["structure"];
  structural["index"] = o.index;
  structural["freedom"] = o.freedom;
  structural["holds"] = start.structure_holds();
  structural["pantelides_agrees"] = start.pantelides == o.equation;
  structural["jacobian"] = {
      {"rank", known ? Json(start.jacobian.rank.rank) : Json(nullptr)},
      {"of", n},
      {"determinant", known ? number_or_null(start.jacobian.determinant) : Json(nullptr)},
      {"cancelling", Json::array()}};
  for (const Eigen::VectorXd& parts : start.jacobian.cancelling)
    structural["jacobian"]["cancelling"].push_back(
        std::vector<double>(parts.data(), parts.data() + parts.size()));
  j["equations"] = Json::array();
  for (int i = 0; i < n; ++i)
    j["equations"].push_back({{"text", file.equations[at(i)].text},
                              {"line", file.equations[at(i)].at.line},
                              {"c", o.equation[at(i)]},
                              {"gives", file.variables[at(o.transversal[at(i)])]}});
  j["variables"] = Json::array();
  for (int k = 0; k < n; ++k)
    j["variables"].push_back(
        {{"name", file.variables[at(k)]},
         {"d", o.variable[at(k)]},
         {"index", known ? Json(start.index_of[at(k)]) : Json(nullptr)},
         {"guess", file.values[at(k)]},
         {"start", known ? number_or_null(start.point.y[k]) : Json(nullptr)},
         {"rate", known ? number_or_null(start.point.ydot[k]) : Json(nullptr)}});
  return j;
}

std::string equation_run_table(const EquationFile& file, const EquationStart& start,
                               const EquationRun& run, const Digits& digits) {
  std::string text =
      name_of(file) + ": index " + std::to_string(start.point.found.index) + ", " + run.integrator +
      ", " +
      (run.step > 0 ? "step " + compact(run.step, 3)
                    : "rtol " + compact(run.rtol, 2) + ", atol " + compact(run.atol, 2)) +
      ": " + std::to_string(run.counters.steps) + " steps, " +
      std::to_string(run.counters.rejected) + " rejected, " +
      std::to_string(run.counters.evaluations) + " evaluations, " +
      std::to_string(run.counters.factorizations) + " factorisations" +
      (run.switchings > 0 ? ", " + std::to_string(run.switchings) + " switchings" : "") + "\n";
  if (const std::string moved = moved_in_words(file, start); !moved.empty())
    text += "The start was moved onto the constraints: " + moved + "\n";
  text += "\n";
  std::vector<std::vector<std::string>> rows{
      {"variable", "at t = " + compact(file.start, 4), "at t = " + compact(run.stopped_at, 4)}};
  for (int j = 0; j < file.size(); ++j)
    rows.push_back({file.variables[at(j)], compact(start.point.y[j], 10),
                    run.last.empty() ? "-" : compact(run.last[at(j)], 10)});
  text += in_columns(rows);
  if (std::isfinite(digits.scd) || std::isfinite(digits.mescd))
    text += "\nDigits of the reference: " + fixed(digits.scd, 2) + " significant (scd), " +
            fixed(digits.mescd, 2) + " mixed (mescd)\n";
  return text;
}

Json equation_run_json(const EquationRun& run, const Digits& digits) {
  return {{"integrator", run.integrator},
          {"rtol", run.rtol},
          {"atol", run.atol},
          {"step", run.step > 0 ? Json(run.step) : Json(nullptr)},
          {"end_time", run.end},
          {"status", run.done ? "done" : "failed"},
          {"reason", run.reason},
          {"stopped_at", number_or_null(run.stopped_at)},
          {"linear_solver", run.linear_solver},
          {"switchings", run.switchings},
          {"counters",
           {{"steps", run.counters.steps},
            {"rejected", run.counters.rejected},
            {"evaluations", run.counters.evaluations},
            {"jacobians", run.counters.jacobians},
            {"factorizations", run.counters.factorizations},
            {"newton_iterations", run.counters.newton_iterations}}},
          {"cpu_s", number_or_null(run.cpu_s)},
          {"scd", number_or_null(digits.scd)},
          {"mescd", number_or_null(digits.mescd)}};
}

Json equation_run_json(const EquationFile& file, const EquationStart& start, const EquationRun& run,
                       const Digits& digits, const Environment& environment) {
  Json j;
  j["name"] = file.name;
  j["index"] = start.point.found.index;
  j.update(equation_run_json(run, digits));
  j["start_moved"] = moved_in_words(file, start);
  Json& ends = j["last"] = Json::object();
  for (int k = 0; k < file.size() && !run.last.empty(); ++k)
    ends[file.variables[at(k)]] = number_or_null(run.last[at(k)]);
  j["environment"] = environment_json(environment);
  return j;
}

std::string equation_trajectory(const EquationFile& file, const EquationRun& run) {
  std::vector<std::string> columns{"t"};
  for (const std::string& name : file.variables) columns.push_back(name);
  std::string text = trajectory_head(columns);
  for (std::size_t k = 0; k < run.t.size(); ++k) {
    std::vector<double> row{run.t[k]};
    row.insert(row.end(), run.y[k].begin(), run.y[k].end());
    text += trajectory_line(row);
  }
  return text;
}

}  // namespace momenta
