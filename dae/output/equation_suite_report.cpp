#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/equation_report.h>
#include <momenta/dae/output/json.h>

namespace momenta {

std::string suite_table(const SuiteResult& suite) {
  std::vector<std::vector<std::string>> rows{{"problem", "unknowns", "index", "method", "tolerance",
                                              "scd", "mescd", "steps", "rejected", "evaluations",
                                              "factorisations", "CPU [s]"}};
  std::string remarks;
  for (const ProblemResult& p : suite.problems) {
    for (std::size_t k = 0; k < p.runs.size(); ++k) {
      const EquationRun& r = p.runs[k];
      rows.push_back({p.name, std::to_string(p.unknowns), std::to_string(p.index), r.integrator,
                      compact(r.rtol, 2), fixed(p.digits[k].scd, 2), fixed(p.digits[k].mescd, 2),
                      std::to_string(r.counters.steps), std::to_string(r.counters.rejected),
                      std::to_string(r.counters.evaluations),
                      std::to_string(r.counters.factorizations), scientific(r.cpu_s, 2)});
      if (!r.done)
        remarks +=
            p.name + ", " + r.integrator + " at " + compact(r.rtol, 2) + ": " + r.reason + "\n";
    }
    if (!p.why.empty()) remarks += p.name + ": " + p.why + "\n";
    if (p.own_reference)
      remarks += p.name + ": reference made in quadruple precision; two tolerances agree to " +
                 scientific(p.accuracy, 1) + "\n";
  }
  return in_columns(rows) + (remarks.empty() ? "" : "\n" + remarks);
}

std::string suite_csv(const SuiteResult& suite) {
  std::string text =
      csv_line({"problem", "unknowns", "index", "method", "tolerance", "status", "scd", "mescd",
                "steps", "rejected", "evaluations", "jacobians", "factorizations", "cpu [s]"});
  for (const ProblemResult& p : suite.problems)
    for (std::size_t k = 0; k < p.runs.size(); ++k) {
      const EquationRun& r = p.runs[k];
      text +=
          csv_line({csv_cell(p.name), std::to_string(p.unknowns), std::to_string(p.index),
                    r.integrator, round_trip(r.rtol), r.done ? "done" : "failed",
                    round_trip(p.digits[k].scd), round_trip(p.digits[k].mescd),
                    std::to_string(r.counters.steps), std::to_string(r.counters.rejected),
                    std::to_string(r.counters.evaluations), std::to_string(r.counters.jacobians),
                    std::to_string(r.counters.factorizations), round_trip(r.cpu_s)});
    }
  return text;
}

nlohmann::ordered_json suite_json(const SuiteResult& suite, const Environment& environment) {
  Json j;
  j["name"] = suite.name;
  j["complete"] = suite.complete;
  j["problems"] = Json::array();
  for (const ProblemResult& p : suite.problems) {
    Json problem{
        {"name", p.name},
        {"file", p.file},
        {"why", p.why},
        {"unknowns", p.unknowns},
        {"index", p.index < 0 ? Json(nullptr) : Json(p.index)},
        {"structural_index", p.structural_index < 0 ? Json(nullptr) : Json(p.structural_index)}};
    Json values = Json::object();
    for (std::size_t i = 0; i < p.reference.size(); ++i)
      if (!p.reference[i].empty()) values[p.variables[i]] = p.reference[i];
    problem["reference"] = {
        {"t", p.t},
        {"own", p.own_reference},
        {"accuracy", p.own_reference ? number_or_null(p.accuracy) : Json(nullptr)},
        {"values", values}};
    problem["runs"] = Json::array();
    for (std::size_t k = 0; k < p.runs.size(); ++k)
      problem["runs"].push_back(equation_run_json(p.runs[k], p.digits[k]));
    j["problems"].push_back(std::move(problem));
  }
  j["environment"] = environment_json(environment);
  return j;
}

}  // namespace momenta
