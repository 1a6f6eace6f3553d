#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/figure.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/page.h>
#include <momenta/dae/output/scene_suite_report.h>

#include <cmath>

namespace momenta {
namespace {

std::string form_text(const RunSettings& s) {
  return s.form + (s.project ? ", projected" : "");
}
/// Gauge of forms with impulses, "" without one.
std::string gauge_text(const RunSettings& s) {
  return s.gauge.empty() || s.gauge == "none" ? "-" : s.gauge;
}
double decimals(double error) {
  return -std::log10(error);
}
std::string error_text(const SceneProblemResult& p) {
  return p.error == BenchmarkError::Kind::threshold ? "threshold " + compact(p.threshold, 2)
                                                    : std::string("mixed");
}

/// "momentum by dop853 at 1e-4: 207 steps, 2837 evaluations"
std::string in_words(const RunResult& run) {
  return form_text(run.settings) + " by " + run.settings.integrator + " at " +
         compact(run.settings.rtol, 2) + ": " + std::to_string(run.counters.steps) + " steps, " +
         std::to_string(run.counters.evaluations) + " evaluations";
}

/// Beside the table: a problem's reference, failures, runs within the source's bounds.
std::vector<std::string> remarks(const SceneProblemResult& p) {
  std::vector<std::string> lines;
  if (!p.why.empty()) lines.push_back(p.why);
  if (!p.reference.empty())
    lines.push_back("error " + error_text(p) + " over " + std::to_string(p.samples) +
                    " outputs to " + compact(p.end, 4) + " s; reference " + p.reference);
  for (const RunResult& run : p.runs)
    if (run.status != "done")
      lines.push_back(form_text(run.settings) + " by " + run.settings.integrator + " at " +
                      compact(run.settings.rtol, 2) + ", " + run.status +
                      (run.reason.empty() ? "" : ": " + run.reason));
  for (const double allowed : p.allowed) {
    const std::size_t best = cheapest_within(p, allowed);
    lines.push_back("within " + compact(allowed, 2) + " with the fewest evaluations, " +
                    (best < p.runs.size() ? in_words(p.runs[best]) : "none of these runs"));
  }
  return lines;
}

std::string caption(const std::string& words) {
  return "<p class=\"caption\">" + escape_html(words) + "</p>";
}
std::string number_of(int n, const char* what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

Chart chart_of(const SceneProblemResult& p) {
  Chart chart;
  chart.title = p.name;
  chart.x_title = "evaluations";
  chart.y_title = "error";
  chart.log_x = chart.log_y = true;
  for (std::size_t k = 0; k < p.runs.size(); ++k) {
    const RunSettings& s = p.runs[k].settings;
    const std::string name = form_text(s) + ", " + s.integrator;
    if (chart.curves.empty() || chart.curves.back().name != name) {
      Curve& curve = chart.curves.emplace_back();
      curve.name = name;
      curve.dots = true;
      curve.sign = sign_in_turn(chart.curves.size() - 1);
    }
    if (!(p.errors[k] > 0)) continue;
    chart.curves.back().x.push_back(static_cast<double>(p.runs[k].counters.evaluations));
    chart.curves.back().y.push_back(p.errors[k]);
  }
  return chart;
}

Json run_json(const RunResult& run, double error) {
  const RunSettings& s = run.settings;
  return {{"form", s.form},
          {"project", s.project},
          {"gauge", s.gauge},
          {"integrator", s.integrator},
          {"rtol", s.rtol},
          {"status", run.status},
          {"reason", run.reason},
          {"error", number_or_null(error)},
          {"drift_unit", run.drift_unit},
          {"position_drift", number_or_null(run.position_drift_max)},
          {"velocity_drift", number_or_null(run.velocity_drift_max)},
          {"energy_error", number_or_null(run.energy_error_max)},
          {"counters",
           {{"steps", run.counters.steps},
            {"rejected", run.counters.rejected},
            {"evaluations", run.counters.evaluations},
            {"jacobians", run.counters.jacobians},
            {"factorizations", run.counters.factorizations}}},
          {"cpu_s", number_or_null(run.cpu_s)}};
}

}  // namespace

std::string suite_table(const SceneSuiteResult& suite) {
  std::vector<std::vector<std::string>> rows{
      {"problem", "form", "gauge", "integrator", "tolerance", "error", "digits", "position drift",
       "energy error [J]", "steps", "rejected", "evaluations", "CPU [s]"}};
  std::string below;
  for (const SceneProblemResult& p : suite.problems) {
    for (std::size_t k = 0; k < p.runs.size(); ++k) {
      const RunResult& r = p.runs[k];
      const std::string drift = scientific(r.position_drift_max, 2);
      rows.push_back(
          {p.name, form_text(r.settings), gauge_text(r.settings), r.settings.integrator,
           compact(r.settings.rtol, 2), scientific(p.errors[k], 2), fixed(decimals(p.errors[k]), 1),
           drift == "-" ? drift : drift + " " + drift_unit(r), scientific(r.energy_error_max, 2),
           std::to_string(r.counters.steps), std::to_string(r.counters.rejected),
           std::to_string(r.counters.evaluations), scientific(r.cpu_s, 2)});
    }
    for (const std::string& line : remarks(p)) below += p.name + ": " + line + "\n";
  }
  return in_columns(rows) + (below.empty() ? "" : "\n" + below);
}

std::string suite_csv(const SceneSuiteResult& suite) {
  std::string text = csv_line({"problem", "coordinates", "equations", "form", "projected", "gauge",
                               "integrator", "tolerance", "status", "error", "position_drift",
                               "velocity_drift", "energy_error [J]", "steps", "rejected",
                               "evaluations", "jacobians", "factorizations", "cpu [s]"});
  for (const SceneProblemResult& p : suite.problems)
    for (std::size_t k = 0; k < p.runs.size(); ++k) {
      const RunResult& r = p.runs[k];
      const RunSettings& s = r.settings;
      text +=
          csv_line({csv_cell(p.name), std::to_string(p.coordinates), std::to_string(p.equations),
                    s.form, s.project ? "true" : "false", s.gauge, s.integrator, round_trip(s.rtol),
                    r.status, round_trip(p.errors[k]), round_trip(r.position_drift_max),
                    round_trip(r.velocity_drift_max), round_trip(r.energy_error_max),
                    std::to_string(r.counters.steps), std::to_string(r.counters.rejected),
                    std::to_string(r.counters.evaluations), std::to_string(r.counters.jacobians),
                    std::to_string(r.counters.factorizations), round_trip(r.cpu_s)});
    }
  return text;
}

Json suite_json(const SceneSuiteResult& suite, const Environment& environment) {
  Json j;
  j["name"] = suite.name;
  j["complete"] = suite.complete;
  j["problems"] = Json::array();
  for (const SceneProblemResult& p : suite.problems) {
    const bool threshold = p.error == BenchmarkError::Kind::threshold;
    Json problem{{"name", p.name},
                 {"scene", p.scene},
                 {"why", p.why},
                 {"coordinates", p.coordinates},
                 {"equations", p.equations},
                 {"end_time", p.end},
                 {"samples", p.samples},
                 {"error", threshold ? "threshold" : "mixed"},
                 {"threshold", threshold ? Json(p.threshold) : Json(nullptr)},
                 {"reference", p.reference},
                 {"columns", p.columns}};
    problem["within"] = Json::array();
    for (const double allowed : p.allowed) {
      const std::size_t best = cheapest_within(p, allowed);
      problem["within"].push_back(
          {{"error", allowed}, {"run", best < p.runs.size() ? Json(best) : Json(nullptr)}});
    }
    problem["runs"] = Json::array();
    for (std::size_t k = 0; k < p.runs.size(); ++k)
      problem["runs"].push_back(run_json(p.runs[k], p.errors[k]));
    j["problems"].push_back(std::move(problem));
  }
  j["environment"] = environment_json(environment);
  return j;
}

std::string suite_page(const SceneSuiteResult& suite, const Environment& environment,
                       const std::string& command) {
  std::string main;
  std::size_t runs = 0, done = 0;
  for (const SceneProblemResult& p : suite.problems) {
    for (const RunResult& r : p.runs) ++runs, done += r.status == "done" ? 1 : 0;
    std::string inside = caption(number_of(p.coordinates, "coordinate") + ", " +
                                 number_of(p.equations, "loop equation"));
    if (!p.runs.empty()) inside += drawn(chart_svg(chart_of(p)));
    for (const std::string& line : remarks(p)) inside += caption(line);
    main += section(p.name, inside);
  }
  main += section("All runs", preformatted(suite_table(suite)));
  return plain_page(suite.name, "suite",
                    std::to_string(done) + " of " + std::to_string(runs) + " runs of " +
                        std::to_string(suite.problems.size()) + " problems came to their end." +
                        (suite.complete ? "" : " The suite was interrupted."),
                    main + how_section(environment, command));
}

}  // namespace momenta
