#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/equation_report.h>
#include <momenta/dae/output/figure.h>
#include <momenta/dae/output/page.h>

#include <cmath>

namespace momenta {
namespace {

constexpr std::size_t curves_of_a_chart = 8;

}  // namespace

std::string equation_run_page(const EquationFile& file, const EquationStart& start,
                              const EquationRun& run, const Digits& digits,
                              const Environment& environment, const std::string& command) {
  std::string main;
  const std::size_t n = file.variables.size();
  std::string charts;
  for (std::size_t first = 0; first < n; first += curves_of_a_chart) {
    Chart chart;
    chart.x_title = "t";
    chart.y_title = "value";
    for (std::size_t j = first; j < std::min(n, first + curves_of_a_chart); ++j) {
      Curve curve;
      curve.name = file.variables[j];
      curve.x = run.t;
      for (const auto& row : run.y) curve.y.push_back(row[j]);
      curve.sign = sign_in_turn(j - first);
      curve.failed = !run.done;
      chart.title += (chart.title.empty() ? "" : ", ") + curve.name;
      chart.curves.push_back(std::move(curve));
    }
    charts += drawn(chart_svg(chart));
  }
  main += section("Solution", charts);
  main += section("The run", preformatted(equation_run_table(file, start, run, digits)));
  main += section("The index", preformatted(equation_index_table(file, start)));
  const std::string answer =
      run.done
          ? "Index " + std::to_string(start.point.found.index) + ", " + run.integrator + " with " +
                std::to_string(run.counters.steps) + " steps to t = " + compact(run.end, 4) + "."
          : "The run stopped: " + escape_html(run.reason);
  return plain_page(file.name.empty() ? "Equations" : file.name, "equations", answer,
                    main + how_section(environment, command));
}

std::string suite_page(const SuiteResult& suite, const Environment& environment,
                       const std::string& command) {
  std::string main;
  for (const ProblemResult& p : suite.problems) {
    if (p.runs.empty()) continue;
    Chart chart;
    chart.title = p.name;
    chart.x_title = "steps";
    chart.y_title = "mixed digits (mescd)";
    chart.log_x = true;
    for (std::size_t k = 0; k < p.runs.size(); ++k) {
      if (chart.curves.empty() || chart.curves.back().name != p.runs[k].integrator) {
        chart.curves.emplace_back();
        chart.curves.back().name = p.runs[k].integrator;
        chart.curves.back().dots = true;
        chart.curves.back().sign = sign_in_turn(chart.curves.size() - 1);
      }
      if (!std::isfinite(p.digits[k].mescd)) continue;
      chart.curves.back().x.push_back(static_cast<double>(p.runs[k].counters.steps));
      chart.curves.back().y.push_back(p.digits[k].mescd);
    }
    std::string words = "Index " + std::to_string(p.index) + ", " + std::to_string(p.unknowns) +
                        " unknowns, to t = " + compact(p.t, 4) + ".";
    if (p.structural_index != p.index)
      words += " The structural index is " + std::to_string(p.structural_index) + ".";
    main += section(
        p.name, "<p class=\"caption\">" + escape_html(words) + "</p>" + drawn(chart_svg(chart)));
  }
  main += section("All runs", preformatted(suite_table(suite)));
  std::size_t runs = 0, done = 0;
  for (const ProblemResult& p : suite.problems)
    for (const EquationRun& r : p.runs) ++runs, done += r.done ? 1 : 0;
  return plain_page(suite.name, "suite",
                    std::to_string(done) + " of " + std::to_string(runs) + " runs of " +
                        std::to_string(suite.problems.size()) + " problems came to their end." +
                        (suite.complete ? "" : " The suite was interrupted."),
                    main + how_section(environment, command));
}

}  // namespace momenta
