#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/number_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/study/own_reference.h>
#include <momenta/dae/study/scene_suite.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

/// Computed output times and those read from a file differ by rounding at most.
constexpr double same_time = 1e-9;  ///< part of the last time

bool is_force(const std::string& column) {
  return column.ends_with("[N]") || column.ends_with("[N m]");
}

std::vector<std::string> judged_columns(const SceneProblem& problem, const Reference& reference) {
  if (problem.columns.empty()) {
    std::vector<std::string> columns;
    for (const std::string& column : reference.columns())
      if (!is_force(column)) columns.push_back(column);
    return columns;
  }
  for (const std::string& column : problem.columns)
    if (std::find(reference.columns().begin(), reference.columns().end(), column) ==
        reference.columns().end())
      throw SceneError(problem.scene + ": column " + reading::in_quotes(column) +
                       " is judged, expected one of the reference's, for instance " +
                       reading::in_quotes(reference.columns().front()));
  return problem.columns;
}

/// The last time of a reference from 0 at equal intervals. @throws SceneError for others
double end_of(const Reference& reference) {
  const std::vector<double>& times = reference.times();
  const double last = times.back();
  const auto count = static_cast<double>(times.size() - 1);
  for (std::size_t i = 0; i < times.size(); ++i)
    if (!(last > 0) ||
        std::abs(times[i] - last / count * static_cast<double>(i)) > same_time * last)
      throw SceneError(reference.file() + ": t = " + compact(times[i], 6) +
                       " s, expected times from 0 at equal intervals");
  return last;
}

template <class GoingOn>
Reference reference_of(const SceneProblem& problem, const Mechanism& mechanism, const Start& start,
                       const SceneSuiteRequest& request, SceneProblemResult& result,
                       GoingOn&& going_on) {
  result.end = problem.end.value_or(mechanism.scene().run.end_time);
  result.samples = problem.samples;
  if (!problem.reference.empty()) {
    Reference read{std::filesystem::path(problem.reference)};
    read.bind(trajectory_columns(mechanism));
    result.end = end_of(read);
    result.samples = static_cast<int>(read.times().size()) - 1;
    result.reference = problem.reference;
    if (!request.own_references) return read;
  }
  OwnReference own = own_reference(mechanism, start, result.end, result.samples, [&](double t) {
    return going_on("reference, t = " + compact(t, 4) + " s");
  });
  result.reference = in_words(own);
  return std::move(own.reference);
}

template <class GoingOn>
void run_problem(const SceneProblem& problem, const SceneSuiteRequest& request,
                 SceneProblemResult& result, GoingOn&& going_on) {
  const Mechanism mechanism(
      parse_scene(reading::text_of(problem.scene), problem.scene, problem.set));
  if (result.name.empty()) result.name = mechanism.scene().name;
  result.coordinates = mechanism.nq();
  result.equations = mechanism.m();
  const Assembly assembly = assemble(mechanism);
  const Reference reference =
      reference_of(problem, mechanism, assembly.start, request, result, going_on);
  result.columns = judged_columns(problem, reference);
  WorkRequest work;
  work.forms = problem.forms;
  work.integrators = problem.integrators;
  work.tolerances = problem.tolerances;
  work.end_time = result.end;
  work.samples = result.samples;
  work.timing = request.timing;
  work.max_cpu_seconds = request.max_cpu_seconds;
  work.keep_trajectories = true;
  work.progress = [&](int, int, const std::string& label, double) { return going_on(label); };
  result.runs = run_work_study(mechanism, assembly.start, work);
  const BenchmarkError error(problem.error, problem.threshold);
  for (RunResult& run : result.runs) {
    result.errors.push_back(error_of(run, reference, result.columns, error));
    run.trajectory = {};
  }
}

}  // namespace

double error_of(const RunResult& run, const Reference& reference,
                const std::vector<std::string>& columns, BenchmarkError error) {
  if (run.status != "done") return std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::vector<double>>& rows = run.trajectory.rows;
  if (rows.size() != reference.times().size())
    throw SceneError(reference.file() + ": found " + std::to_string(reference.times().size()) +
                     " times, expected the " + std::to_string(rows.size()) + " of the run");
  const auto place = [](const std::vector<std::string>& names, const std::string& name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (std::abs(rows[i].front() - reference.times()[i]) > same_time * reference.times().back())
      throw SceneError(reference.file() + ": found t = " + compact(reference.times()[i], 6) +
                       " s, expected " + compact(rows[i].front(), 6) + " s as of the run");
  for (const std::string& column : columns) {
    const std::size_t ours = place(run.trajectory.columns, column),
                      theirs = place(reference.columns(), column);
    for (std::size_t i = 1; i < rows.size(); ++i)
      error.add(rows[i].at(ours), reference.values()[i].at(theirs));
  }
  return error.value();
}

SceneSuiteResult run_suite(const SceneSuite& suite, const SceneSuiteRequest& request) {
  SceneSuiteResult result;
  result.name = suite.name;
  const int total = static_cast<int>(suite.problems.size());
  for (int k = 0; k < total && result.complete; ++k) {
    const SceneProblem& problem = suite.problems[static_cast<std::size_t>(k)];
    SceneProblemResult& row = result.problems.emplace_back();
    row.scene = problem.scene;
    row.name = problem.name;
    row.set = problem.set;
    row.error = problem.error;
    row.threshold = problem.threshold;
    row.allowed = problem.allowed;
    const auto going_on = [&](const std::string& what) {
      const std::string name =
          row.name.empty() ? std::filesystem::path(row.scene).stem().string() : row.name;
      result.complete &= !request.progress || request.progress(k + 1, total, name + "  " + what);
      return result.complete;
    };
    try {
      run_problem(problem, request, row, going_on);
    } catch (const std::exception& e) {
      row.why = e.what();
      row.runs.clear();
      row.errors.clear();
    }
    if (row.name.empty()) row.name = std::filesystem::path(row.scene).stem().string();
  }
  return result;
}

std::size_t cheapest_within(const SceneProblemResult& problem, double allowed) {
  std::size_t best = problem.errors.size();
  for (std::size_t k = 0; k < problem.errors.size(); ++k)
    if (problem.errors[k] <= allowed &&
        (best == problem.errors.size() ||
         problem.runs[k].counters.evaluations < problem.runs[best].counters.evaluations))
      best = k;
  return best;
}

}  // namespace momenta
