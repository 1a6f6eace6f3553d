#include <momenta/core/format/toml/fields.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/number_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/equations/suite.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace momenta {
namespace {

using namespace reading;

std::vector<std::string> methods_in(const Fields& table,
                                    const std::vector<std::string>& otherwise) {
  if (!table.has("methods")) return otherwise;
  std::vector<std::string> methods = table.texts("methods");
  for (const std::string& name : methods)
    if (name != "ida" && name != "radau5")
      table.fail_key("methods", "has " + in_quotes(name) + ", expected \"ida\" or \"radau5\"");
  return methods;
}
std::vector<double> tolerances_in(const Fields& table, const std::vector<double>& otherwise) {
  if (!table.has("tolerances")) return otherwise;
  std::vector<double> tolerances = table.numbers("tolerances", {});
  for (const double x : tolerances)
    if (!(x > 0 && x < 1))
      table.fail_key("tolerances", "has " + digits(x) + ", expected numbers between 0 and 1");
  return tolerances;
}

/// Least time of three runs; long runs are not repeated.
void time_run(EquationRun& run, const EquationFile& file, const EquationStart& start,
              const EquationRunRequest& request) {
  for (int round = 1; round < 3 && run.done && run.cpu_s < 0.5; ++round)
    run.cpu_s = std::min(run.cpu_s, run_equations(file, start, request).cpu_s);
}

}  // namespace

Suite read_suite(const std::filesystem::path& path) {
  const std::string file = path.string();
  const Value root = parse_toml(text_of(path, "suite"), file);
  const Fields table(root, "", file);
  table.allow({"name", "methods", "tolerances", "problem"});
  Suite suite;
  suite.file = file;
  suite.name = table.text("name", path.stem().string());
  const std::vector<std::string> methods = methods_in(table, {"ida", "radau5"});
  const std::vector<double> tolerances = tolerances_in(table, {1e-4, 1e-6, 1e-8, 1e-10});
  for (const Fields& t : table.tables("problem", "problem")) {
    t.allow({"file", "methods", "tolerances"});
    const std::filesystem::path named = t.text("file");
    SuiteProblem problem;
    problem.file = (named.is_absolute() ? named : path.parent_path() / named).string();
    if (!std::filesystem::is_regular_file(problem.file))
      t.fail_key("file", "is " + in_quotes(named.string()) + ", expected a file of equations");
    problem.methods = methods_in(t, methods);
    problem.tolerances = tolerances_in(t, tolerances);
    suite.problems.push_back(std::move(problem));
  }
  if (suite.problems.empty())
    fail(file, {1, 1}, "the suite has no problem, expected at least one [[problem]]");
  return suite;
}

ProblemResult run_problem(const EquationFile& file, const SuiteProblem& problem,
                          const SuiteRequest& request,
                          const std::function<bool(const std::string&)>& going_on) {
  ProblemResult result;
  result.file = problem.file;
  result.name = file.name.empty() ? std::filesystem::path(problem.file).stem().string() : file.name;
  result.unknowns = file.size();
  result.variables = file.variables;
  const EquationStart start = equation_start(file);
  result.structural_index = start.offsets.index;
  if (!start.point.why.empty())
    throw std::runtime_error(file.where({}) + "no consistent start: " + start.point.why);
  result.index = start.point.found.index;
  result.t = file.reference ? file.reference->t : file.end;
  std::vector<double> values(static_cast<std::size_t>(file.size()),
                             std::numeric_limits<double>::quiet_NaN());
  std::vector<char> judged(values.size(), 1);
  if (file.reference) judged = file.reference->judged;
  if (file.reference && !request.own_references) {
    values = file.reference->values;
    for (const double x : values) result.reference.push_back(round_trip(x));
  } else {
    const QuadReference own = quad_reference(file, start, result.t, [&](double t) {
      return going_on("reference, t = " + compact(t, 4));
    });
    result.own_reference = true;
    result.accuracy = own.accuracy;
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = value_of(own.values[i]);
      result.reference.push_back(decimals_of(own.values[i], 25));
    }
  }
  for (const std::string& method : problem.methods)
    for (const double tolerance : problem.tolerances) {
      if (!going_on(method + " at " + compact(tolerance, 2))) return result;
      if (result.index > largest_index(method)) continue;
      EquationRunRequest run;
      run.integrator = method;
      run.rtol = run.atol = tolerance;
      run.end = result.t;
      run.max_cpu_seconds = request.max_cpu_seconds;
      EquationRun done = run_equations(file, start, run);
      if (request.timing == SuiteRequest::Timing::rounds) time_run(done, file, start, run);
      if (request.timing == SuiteRequest::Timing::none)
        done.cpu_s = std::numeric_limits<double>::quiet_NaN();
      result.digits.push_back(digits_of(done, file, values, judged));
      result.runs.push_back(std::move(done));
    }
  return result;
}

SuiteResult run_suite(const Suite& suite, const SuiteRequest& request) {
  SuiteResult result;
  result.name = suite.name;
  const int total = static_cast<int>(suite.problems.size());
  for (int k = 0; k < total && result.complete; ++k) {
    const SuiteProblem& problem = suite.problems[static_cast<std::size_t>(k)];
    const auto going_on = [&](const std::string& what) {
      const std::string stem = std::filesystem::path(problem.file).stem().string();
      result.complete &= !request.progress || request.progress(k + 1, total, stem + "  " + what);
      return result.complete;
    };
    try {
      result.problems.push_back(
          run_problem(read_equations(problem.file), problem, request, going_on));
    } catch (const std::exception& e) {
      ProblemResult none;
      none.file = problem.file;
      none.name = std::filesystem::path(problem.file).stem().string();
      none.why = e.what();
      result.problems.push_back(std::move(none));
    }
  }
  return result;
}

}  // namespace momenta
